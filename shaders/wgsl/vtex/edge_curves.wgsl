//!use core/layout
//!use vtex/curve
// The edge inside an entry's cell where it can be a curve record alone.
// Distances are in texels, inside positive; only the sign is right when `sharp`.

fn vtex_edge_in(entry: vec2u) -> bool {
    return (entry.x >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_CURVES;
}

fn vtex_edge_distance(vt: u32, entry: vec2u, q: vec2f, sharp: bool) -> f32 {
    return vtex_curve_texels(vt, entry.y, q, sharp);
}
