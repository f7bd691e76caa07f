//!use core/layout
//!use vtex/msdf
//!use vtex/curve
// The edge inside an entry's cell: an MSDF tile or a curve record.
// Distances are in texels, inside positive; only the sign is right when `sharp`.

fn vtex_edge_in(entry: vec2u) -> bool {
    let kind = entry.x >> VTEX_ENTRY_KIND_SHIFT;
    return kind == VTEX_ENTRY_MSDF || kind == VTEX_ENTRY_CURVES;
}

fn vtex_edge_distance(vt: u32, entry: vec2u, q: vec2f, sharp: bool) -> f32 {
    if (entry.x >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_CURVES {
        return vtex_curve_texels(vt, entry.y, q, sharp);
    }
    return vtex_msdf_distance(vt, entry.y, q);
}
