//!use core/layout
//!use vtex/msdf
// The edge inside an entry's cell where it can be an MSDF tile alone.
// Distances are in texels, inside positive; only the sign is right when `sharp`.

fn vtex_edge_in(entry: vec2u) -> bool {
    return (entry.x >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_MSDF;
}

fn vtex_edge_distance(vt: u32, entry: vec2u, q: vec2f, sharp: bool) -> f32 {
    return vtex_msdf_distance(vt, entry.y, q);
}
