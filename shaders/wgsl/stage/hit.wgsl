//!use state/paths
//!use trace/bvh
// What each path meets next.

@compute @workgroup_size(64)
fn stage_hit(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    if id.x >= list_length() {
        return;
    }
    let path = list_entry(id.x);
    if (path & ENTRY_VEIL) != 0u {
        // Its shadow ray has met something already.
        return;
    }
    stack_begin(lane, path);
    let origin = state_float(path, STATE_ORIGIN).xyz;
    let direction = state_float(path, STATE_DIRECTION).xyz;
    state_set_hit(path, bvh_closest(ray_new(origin, direction, RAY_INFINITY)));
}
