//!use state/paths
// What lies where rays have met something: light of the sky for those that did not, and for those that
// met a texture a query, in the queue of the kernel that answers it.

// Queue `k` has as much room as there are paths, from k times that on.
@group(2) @binding(0) var<storage, read_write> stage_queries: array<VtexBatchQuery>;

@compute @workgroup_size(64)
fn stage_surface(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= list_length() {
        return;
    }
    let entry = list_entry(id.x);
    let path = entry & ENTRY_PATH;
    let is_veil = (entry & ENTRY_VEIL) != 0u;
    let hit = state_hit(path);
    var about = state_word(path, STATE_LOOKUP);
    about.x = TRACE_NONE;
    // That of the shadow ray is counted where it is traced.
    about.y += select(1u, 0u, is_veil);
    if hit.triangle == TRACE_NONE {
        state_set(path, STATE_LOOKUP, about);
        state_set_float(path, STATE_COLOR, path_escape(state_path(path)));
        return;
    }
    let material = trace_materials[surface_material(hit)];
    if material.texture_word != TRACE_NONE {
        about.x = surface_ask(path, is_veil, hit, material);
    }
    state_set(path, STATE_LOOKUP, about);
}

// Puts a query into its queue; where its answer will be.
fn surface_ask(path: u32, is_veil: bool, hit: Hit, material: MaterialRecord) -> u32 {
    let origin = state_float(path, select(STATE_ORIGIN, STATE_SHADOW_ORIGIN, is_veil));
    let direction = state_float(path, select(STATE_DIRECTION, STATE_SHADOW_DIRECTION, is_veil));
    var cone = cone_at(Cone(origin.w, direction.w), hit.t);
    if is_veil {
        cone = path_shadow_cone(state_shadow(path), hit.t);
    }
    let point = surface_at(ray_new(origin.xyz, direction.xyz, RAY_INFINITY), hit, cone);
    let place = atomicAdd(&stage_counts[COUNT_LOOKUPS + material.texture_queue], 1u);
    let slot = material.texture_queue * state_room() + place;
    let first_word = bitcast<vec2f>(vec2u(material.texture_word, path));
    stage_queries[slot] = VtexBatchQuery(point.uv, first_word, point.footprint);
    return slot;
}
