//!use state/paths
//!use trace/bvh
// Rays to lights: what comes through, and what waits for a see-through surface.

@compute @workgroup_size(64)
fn stage_shadow(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    if id.x >= list_shadows() {
        return;
    }
    let entry = list_shadow(id.x);
    let path = entry & ENTRY_PATH;
    stack_begin(lane, path);
    let origin = state_float(path, STATE_SHADOW_ORIGIN);
    let direction = state_float(path, STATE_SHADOW_DIRECTION).xyz;
    let hit = bvh_any(ray_new(origin.xyz, direction, origin.w));
    var about = state_word(path, STATE_LOOKUP);
    about.y += 1u;
    state_set(path, STATE_LOOKUP, about);
    if hit.triangle != TRACE_NONE && !bvh_stops(hit) {
        state_set_hit(path, hit);
        list_push(entry | ENTRY_VEIL);
        return;
    }
    if hit.triangle == TRACE_NONE {
        state_set_float(path, STATE_COLOR, path_lit(state_float(path, STATE_COLOR), state_shadow(path)));
    }
    if (entry & ENTRY_LAST) == 0u {
        list_push(path);
    }
}
