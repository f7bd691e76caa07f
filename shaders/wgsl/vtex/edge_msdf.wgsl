//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/msdf
// The edge of an entry where it can be an MSDF tile alone.

struct VtexEdge {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    // In texels, inside positive; where the entry fills its cell, far inside.
    distance: f32,
}

fn vtex_edge(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexEdge {
    let item = vtex_word4(vt, first);
    var distance = 1e9;
    if (item.w & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_MSDF {
        distance = vtex_msdf_distance(vt, item.x, lookup.q);
    }
    return VtexEdge(item, first + VTEX_ITEM_WORDS, distance);
}
