//!use state/colors
// Light at the surfaces that paths met, rays to lights, and the way on.

@compute @workgroup_size(64)
fn stage_shade(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= list_length() {
        return;
    }
    let path = list_entry(id.x);
    if (path & ENTRY_VEIL) != 0u {
        return;
    }
    let hit = state_hit(path);
    if hit.triangle == TRACE_NONE {
        return;
    }
    var state = state_path(path);
    var stream = state_stream(path);
    path_arrive(&state, hit.t);
    let point = surface_at(state.ray, hit, state.cone);
    let material = trace_materials[point.material];
    var color = colors_at(path, material);
    if LAYERS_HAVE_COLORS {
        color.base_color *= surface_color(hit);
    }
    if color.alpha < 1.0 && rng_next(&stream) >= color.alpha {
        // The count of the state that is local here starts at none.
        if path_pass(&state, point) && colors_pass(path) {
            state_set_way(path, state, stream);
            list_push(path);
        }
        return;
    }
    path_absorb(&state, material, point, hit.t);
    // What is done is stored at once, not kept in registers while the next is computed.
    state_set_float(path, STATE_COLOR, path_emission(state, material, point, color.base_color));
    if path_ends(state, material) {
        return;
    }
    let lobes = path_lobes(state, material, point, color.base_color, &stream);
    let shadow = path_shadow_ray(state, point, lobes, &stream);
    let is_lit = shadow.left > 0.0;
    if is_lit {
        state_set_shadow(path, shadow);
    }
    // Read again, for the same reason.
    var way = state_path(path);
    path_arrive(&way, hit.t);
    path_absorb(&way, material, point, hit.t);
    var goes_on = false;
    if LAYERS_HAVE_GLASS && lobes.is_glass {
        goes_on = path_refract(&way, point, lobes, material, color.base_color, &stream);
    } else {
        goes_on = path_scatter(&way, point, lobes, &stream);
    }
    state_set_way(path, way, stream);
    if is_lit {
        list_push_shadow(path | select(ENTRY_LAST, 0u, goes_on));
    } else if goes_on {
        list_push(path);
    }
}
