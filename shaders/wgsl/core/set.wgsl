// A set of textures, as in shaders/src/set; a test compares every constant through naga.

const VTEX_SET_COUNT: u32 = 0u;
const VTEX_SET_NOTHING: u32 = 1u;
const VTEX_SET_POOL: u32 = 2u;
const VTEX_SET_ENTRIES: u32 = 4u;
const VTEX_SET_ENTRY_WORDS: u32 = 2u;
const VTEX_SET_SLOT_MASK: u32 = 0xffffu;
const VTEX_SET_POOL_SHIFT: u32 = 16u;
const VTEX_SET_POOL_MASK: u32 = 0x1fu;

// One query of a queue.
struct VtexTextureQuery {
    uv: vec2f,
    handle: u32,
    user: u32,
    footprint: vec4f,
}

// What one pool answers of a queue that is in order.
struct VtexQueuePart {
    // Arguments of its dispatch.
    groups: vec3u,
    // Queries, and the place of the first in the order.
    count: u32,
    first: u32,
    // Pools of the set, the same in each part.
    pools: u32,
    padding: vec2u,
}
