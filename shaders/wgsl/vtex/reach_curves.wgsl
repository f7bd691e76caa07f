//!use core/layout
//!use vtex/texture
//!use vtex/curve
//!use vtex/segment
//!use vtex/distance
//!use vtex/winding
// The signed distance of an entry whose edge can be curves alone, item by item.

fn vtex_reach_point(vt: VtexTexture, q: vec2f) -> vec2f {
    return vtex_curve_point(vt, q);
}

// In units, squared: how far a record knows its outline.
fn vtex_reach_squared(vt: VtexTexture) -> f32 {
    return vt.curve_units.y * vt.curve_units.y;
}

fn vtex_reach_winding(item: vec4u, p: vec2f) -> i32 {
    return vtex_segment_winding(item, p);
}

fn vtex_reach_distance_squared(vt: VtexTexture, item: vec4u, p: vec2f) -> f32 {
    // Not an outline's: a change of the winding, or nothing.
    let ghost = (item.w & VTEX_ITEM_GHOST_BIT) != 0u;
    return select(vtex_segment_distance_squared(item, p), vtex_reach_squared(vt), ghost);
}

// In texels, inside positive. `item` is the entry's last, `winding` that of all its items and
// `nearest` the least of their squared distances, at most the reach. Far beyond every ramp where
// no segment is in reach or the entry fills its cell.
fn vtex_reach_texels(
    vt: VtexTexture,
    item: vec4u,
    winding: i32,
    nearest: f32,
    q: vec2f,
) -> f32 {
    if (item.w & VTEX_ITEM_KIND_MASK) != VTEX_ITEM_CURVES {
        return 1e9;
    }
    let units = sqrt(nearest);
    let texels = units / vt.curve_units.x * f32(vt.texels_per_cell);
    // The slack is for square roots that are not correctly rounded.
    let distance = select(texels, 1e9, units >= vt.curve_units.y * 0.999999);
    return select(-distance, distance, vtex_winding_fills(item.w, winding));
}
