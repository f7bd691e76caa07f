//!use state/paths
// Lengths of lists as arguments of dispatches, four words each: paths, shadow rays, then the queues.

@group(2) @binding(0) var<storage, read_write> stage_dispatch: array<vec4u>;

const DISPATCH_PATHS: u32 = 0u;
const DISPATCH_SHADOWS: u32 = 1u;
const DISPATCH_LOOKUPS: u32 = 2u;

fn dispatch_set(place: u32, length: u32) {
    stage_dispatch[place] = vec4u((length + 63u) / 64u, 1u, 1u, 0u);
}
