//!use core/layout
//!use vtex/footprint
//!use vtex/msdf
//!use vtex/curve
//!use vtex/run
// The edge of an entry: an MSDF tile or curves.

struct VtexEdge {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    // In texels, inside positive; where the entry fills its cell, far inside.
    distance: f32,
}

fn vtex_edge(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexEdge {
    let run = vtex_run(vt, first, vtex_curve_point(vt, lookup.q));
    let kind = run.item.w & VTEX_ITEM_KIND_MASK;
    var distance = select(1e9, vtex_run_texels(vt, run), kind == VTEX_ITEM_CURVES);
    if kind == VTEX_ITEM_MSDF {
        distance = vtex_msdf_distance(vt, run.item.x, lookup.q);
    }
    return VtexEdge(run.item, run.next, distance);
}
