//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/edge
//!use vtex/ramp
// Coverage of an entry: its edge, or the whole cell. An image fills its cell and is transparent
// outside its rectangle.

fn vtex_coverage(vt: u32, entry: vec2u, lookup: VtexLookup) -> f32 {
    if !vtex_edge_in(entry) {
        return 1.0;
    }
    let sharp = vtex_word(vt, VTEX_HEADER_FILTER) == VTEX_FILTER_POINT;
    let distance = vtex_edge_distance(vt, entry, lookup.q, sharp);
    return vtex_ramp_coverage(vt, distance, lookup.width_cells);
}
