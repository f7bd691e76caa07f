//!use core/layout
//!use vtex/footprint
//!use vtex/curve
//!use vtex/run
// The edge of an entry where it can be curves alone.

struct VtexEdge {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    // In texels, inside positive; where the entry fills its cell, far inside.
    distance: f32,
}

fn vtex_edge(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexEdge {
    let run = vtex_run(vt, first, vtex_curve_point(vt, lookup.q));
    let curves = (run.item.w & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_CURVES;
    return VtexEdge(run.item, run.next, select(1e9, vtex_run_texels(vt, run), curves));
}
