//!use state/colors
// What a see-through surface leaves of a shadow ray.

@compute @workgroup_size(64)
fn stage_veil(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= list_length() {
        return;
    }
    let entry = list_entry(id.x);
    if (entry & ENTRY_VEIL) == 0u {
        return;
    }
    let path = entry & ENTRY_PATH;
    let hit = state_hit(path);
    var shadow = state_shadow(path);
    let ray = ray_new(shadow.origin, shadow.direction, shadow.left);
    let point = surface_at(ray, hit, path_shadow_cone(shadow, hit.t));
    let alpha = colors_at(path, trace_materials[point.material]).alpha;
    if !colors_pass(path) {
        return;
    }
    if path_shadow_pass(&shadow, point, hit.t, alpha) {
        state_set_shadow(path, shadow);
        list_push_shadow(entry & ~ENTRY_VEIL);
    } else if (entry & ENTRY_LAST) == 0u {
        list_push(path);
    }
}
