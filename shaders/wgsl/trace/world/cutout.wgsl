//!use core/layout
//!use trace/world/veil
// See-through surfaces where their texture's cells tell that nothing is there, or nothing lies behind, so that
// traversal needs no lookup. A cutout lies among the nodes:
//   0     columns, rows, address modes along u and v
//   1, 2  texture matrix (a, b, c, d; e, f)
//   3     cells a unit of uv, and place of uv 0 in cells
//   then  cells, row by row, two bits each, 64 in a group of four words
// Scenes without any have trace/world/cutout_none instead.

const CUTOUT_MIXED: u32 = 0u;
const CUTOUT_OPAQUE: u32 = 1u;
const CUTOUT_EMPTY: u32 = 2u;
const CUTOUT_GROUPS: u32 = 4u;

fn cutout_along(t: f32, mode: u32) -> f32 {
    if mode == VTEX_ADDRESS_REPEAT {
        return t - floor(t);
    }
    if mode == VTEX_ADDRESS_MIRROR {
        let turn = t - 2.0 * floor(0.5 * t);
        return min(turn, 2.0 - turn);
    }
    return clamp(t, 0.0, 1.0);
}

fn cutout_at(cutout: u32, uv: vec2f) -> u32 {
    let about = trace_nodes[cutout];
    let m = bitcast<vec4f>(trace_nodes[cutout + 1u]);
    let moved = bitcast<vec4f>(trace_nodes[cutout + 2u]);
    let lattice = bitcast<vec4f>(trace_nodes[cutout + 3u]);
    let place = vec2f(m.x * uv.x + m.z * uv.y, m.y * uv.x + m.w * uv.y) + moved.xy;
    let kept = vec2f(cutout_along(place.x, about.z), cutout_along(place.y, about.w));
    let outside = place != clamp(place, vec2f(0.0), vec2f(1.0));
    if any(outside & (about.zw == vec2u(VTEX_ADDRESS_BORDER))) {
        return CUTOUT_EMPTY;
    }
    let cell = min(vec2u(kept * lattice.xy + lattice.zw), about.xy - 1u);
    let index = cell.y * about.x + cell.x;
    let word = trace_nodes[cutout + CUTOUT_GROUPS + index / 64u][index / 16u % 4u];
    return word >> (2u * (index % 16u)) & 3u;
}

// What is known of a see-through surface where it was met.
fn cutout_of(hit: Hit) -> u32 {
    let cutout = trace_materials[surface_material(hit)].cutout;
    if cutout == 0u {
        return CUTOUT_MIXED;
    }
    let attributes = trace_attributes[hit.triangle];
    let weights = vec3f(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    let u3 = vec3f(attributes.normal0_u.w, attributes.normal1_u.w, attributes.normal2_u.w);
    return cutout_at(cutout, vec2f(dot(weights, u3), dot(weights, attributes.v_material.xyz)));
}

// Whether a ray passes as if nothing were there.
fn cutout_hides(hit: Hit) -> bool {
    return bvh_is_veil(hit) && cutout_of(hit) == CUTOUT_EMPTY;
}

// Whether a ray ends there whatever a lookup would say.
fn bvh_stops(hit: Hit) -> bool {
    return !bvh_is_veil(hit) || cutout_of(hit) == CUTOUT_OPAQUE;
}
