//!use core/query
//!use trace/layout
//!use path/steps
// Paths between the stages: their state, and lists of those that a stage has work for.
//
// A path is a number below the state's room. The state holds STATE_FIELDS words of 16 bytes of each,
// field by field, so that neighbours read neighbours. Floats are stored as their bits: a word that
// holds a small integer would be a denormal number, which a device may flush to zero.

@group(1) @binding(0) var<storage, read_write> stage_state: array<vec4u>;
@group(1) @binding(1) var<storage, read_write> stage_counts: array<atomic<u32>>;
@group(1) @binding(2) var<storage, read_write> stage_lists: array<u32>;

const STATE_ORIGIN: u32 = 0u;
const STATE_DIRECTION: u32 = 1u;
const STATE_THROUGHPUT: u32 = 2u;
const STATE_COLOR: u32 = 3u;
const STATE_COUNTS: u32 = 4u;
const STATE_HIT: u32 = 5u;
// The place of the answer of its lookup or TRACE_NONE, rays so far, veils so far, the instance that was hit.
const STATE_LOOKUP: u32 = 6u;
const STATE_SHADOW_ORIGIN: u32 = 7u;
const STATE_SHADOW_DIRECTION: u32 = 8u;
const STATE_SHADOW_LIGHT: u32 = 9u;
const STATE_SHADOW_CONE: u32 = 10u;
const STATE_FIELDS: u32 = 11u;

// Of the two lists of paths that wait for their next surface, COUNT_PARITY says which is read; the other
// one is filled. Lengths are at 0 and 1.
const COUNT_SHADOWS: u32 = 2u;
const COUNT_PARITY: u32 = 3u;
const COUNT_LOOKUPS: u32 = 4u;

// What a list says of a path. VEIL: its shadow ray has met a see-through surface, and waits for what that
// lets through. LAST: when its shadow ray is done the path ends.
const ENTRY_VEIL: u32 = 0x80000000u;
const ENTRY_LAST: u32 = 0x40000000u;
const ENTRY_PATH: u32 = 0x3fffffffu;

fn state_room() -> u32 {
    return arrayLength(&stage_state) / STATE_FIELDS;
}

fn state_word(path: u32, field: u32) -> vec4u {
    return stage_state[field * state_room() + path];
}

fn state_float(path: u32, field: u32) -> vec4f {
    return bitcast<vec4f>(state_word(path, field));
}

fn state_set(path: u32, field: u32, value: vec4u) {
    stage_state[field * state_room() + path] = value;
}

fn state_set_float(path: u32, field: u32, value: vec4f) {
    state_set(path, field, bitcast<vec4u>(value));
}

// The length of the list of paths that is read.
fn list_length() -> u32 {
    return min(atomicLoad(&stage_counts[atomicLoad(&stage_counts[COUNT_PARITY])]), state_room());
}

fn list_entry(place: u32) -> u32 {
    return stage_lists[atomicLoad(&stage_counts[COUNT_PARITY]) * state_room() + place];
}

// Puts a path on the list that is read next.
fn list_push(entry: u32) {
    let list = 1u - atomicLoad(&stage_counts[COUNT_PARITY]);
    let place = atomicAdd(&stage_counts[list], 1u);
    stage_lists[list * state_room() + place] = entry;
}

fn list_shadows() -> u32 {
    return min(atomicLoad(&stage_counts[COUNT_SHADOWS]), state_room());
}

fn list_shadow(place: u32) -> u32 {
    return stage_lists[2u * state_room() + place];
}

fn list_push_shadow(entry: u32) {
    let place = atomicAdd(&stage_counts[COUNT_SHADOWS], 1u);
    stage_lists[2u * state_room() + place] = entry;
}

fn state_hit(path: u32) -> Hit {
    let word = state_word(path, STATE_HIT);
    var instance = 0u;
    if WORLD_HAS_INSTANCES {
        instance = state_word(path, STATE_LOOKUP).w;
    }
    return Hit(bitcast<f32>(word.x), word.y, instance, bitcast<vec2f>(word.zw));
}

fn state_set_hit(path: u32, hit: Hit) {
    state_set(path, STATE_HIT, vec4u(bitcast<u32>(hit.t), hit.triangle, bitcast<vec2u>(hit.barycentric)));
    if WORLD_HAS_INSTANCES {
        stage_state[STATE_LOOKUP * state_room() + path].w = hit.instance;
    }
}

// Without its counts of rays and veils.
fn state_path(path: u32) -> PathState {
    let origin = state_float(path, STATE_ORIGIN);
    let direction = state_float(path, STATE_DIRECTION);
    let throughput = state_float(path, STATE_THROUGHPUT);
    let counts = state_word(path, STATE_COUNTS);
    return PathState(
        ray_new(origin.xyz, direction.xyz, RAY_INFINITY),
        Cone(origin.w, direction.w),
        throughput.xyz,
        counts.y,
        throughput.w,
        bitcast<f32>(counts.x),
        0u,
        0u,
        state_float(path, STATE_COLOR),
    );
}

fn state_stream(path: u32) -> u32 {
    return state_word(path, STATE_COUNTS).z;
}

// All of it but its colour and counts of rays and veils.
fn state_set_way(path: u32, value: PathState, stream: u32) {
    state_set_float(path, STATE_ORIGIN, vec4f(value.ray.origin, value.cone.width));
    state_set_float(path, STATE_DIRECTION, vec4f(value.ray.direction, value.cone.slope));
    state_set_float(path, STATE_THROUGHPUT, vec4f(value.throughput, value.scatter_pdf));
    state_set(path, STATE_COUNTS, vec4u(bitcast<u32>(value.travelled), value.scatterings, stream, 0u));
}

fn state_shadow(path: u32) -> ShadowRay {
    let origin = state_float(path, STATE_SHADOW_ORIGIN);
    let direction = state_float(path, STATE_SHADOW_DIRECTION);
    let light = state_float(path, STATE_SHADOW_LIGHT);
    let cone = state_word(path, STATE_SHADOW_CONE);
    return ShadowRay(
        origin.xyz,
        direction.xyz,
        origin.w,
        direction.w,
        light.xyz,
        light.w,
        Cone(bitcast<f32>(cone.x), bitcast<f32>(cone.y)),
        cone.z,
    );
}

fn state_set_shadow(path: u32, value: ShadowRay) {
    state_set_float(path, STATE_SHADOW_ORIGIN, vec4f(value.origin, value.left));
    state_set_float(path, STATE_SHADOW_DIRECTION, vec4f(value.direction, value.distance));
    state_set_float(path, STATE_SHADOW_LIGHT, vec4f(value.radiance, value.share));
    let cone = bitcast<vec2u>(vec2f(value.cone.width, value.cone.slope));
    state_set(path, STATE_SHADOW_CONE, vec4u(cone, value.scatterings, 0u));
}
