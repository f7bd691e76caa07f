//!use core/layout
//!use vtex/words
//!use vtex/segment
//!use vtex/distance
//!use vtex/winding
// The items of one entry where coverage comes from a distance.

struct VtexRun {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    inside: bool,
    // To the nearest segment in units, squared; at most the reach.
    nearest: f32,
}

// `p` is in units of the cell's box.
fn vtex_run(vt: VtexTexture, first: u32, p: vec2f) -> VtexRun {
    let reach = vt.curve_units.y;
    var item = vec4u(0u);
    var next = first;
    var winding = 0;
    var nearest = reach * reach;
    for (var i = 0u; i < VTEX_ITEM_LIMIT; i += 1u) {
        item = vtex_word4(vt, next);
        next += VTEX_ITEM_WORDS;
        winding += vtex_segment_winding(item, p);
        // Not an outline's: a change of the winding, or nothing.
        if (item.w & VTEX_ITEM_GHOST_BIT) == 0u {
            nearest = min(nearest, vtex_segment_distance_squared(item, p));
        }
        if (item.w & VTEX_ITEM_END_BIT) != 0u {
            break;
        }
    }
    return VtexRun(item, next, vtex_winding_fills(item.w, winding), nearest);
}

// In texels, inside positive, far beyond every ramp where no segment is in reach.
fn vtex_run_texels(vt: VtexTexture, run: VtexRun) -> f32 {
    let reach = vt.curve_units.y;
    let units = sqrt(run.nearest);
    let texels = units / vt.curve_units.x * f32(vt.texels_per_cell);
    // The slack is for square roots that are not correctly rounded.
    let distance = select(texels, 1e9, units >= reach * 0.999999);
    return select(-distance, distance, run.inside);
}
