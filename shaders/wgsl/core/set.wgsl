// A set of textures, as in shaders/src/set; a test compares every constant through naga.

const VTEX_SET_COUNT: u32 = 0u;
const VTEX_SET_NOTHING: u32 = 1u;
const VTEX_SET_ENTRIES: u32 = 4u;
const VTEX_SET_ENTRY_WORDS: u32 = 2u;
const VTEX_SET_SLOT_MASK: u32 = 0xfffffu;

// One query of a queue.
struct VtexTextureQuery {
    uv: vec2f,
    handle: u32,
    user: u32,
    footprint: vec4f,
}
