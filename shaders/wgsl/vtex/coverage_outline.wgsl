//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/edge
//!use vtex/ramp
// Coverage of an entry and of the ring around it, [SFG22] eq. 2.

// x: the shape, y: the ring; their sum is at most 1.
fn vtex_coverage_outline(vt: u32, entry: vec2u, lookup: VtexLookup) -> vec2f {
    if !vtex_edge_in(entry) {
        return vec2f(1.0, 0.0);
    }
    let distance = vtex_edge_distance(vt, entry, lookup.q, false);
    let grown = distance + vtex_word_float(vt, VTEX_HEADER_OUTLINE_WIDTH);
    let inner = vtex_ramp_coverage(vt, distance, lookup.width_cells);
    let outer = vtex_ramp_coverage(vt, grown, lookup.width_cells);
    return vec2f(inner, max(outer - inner, 0.0));
}

fn vtex_coverage_outline_paint(vt: u32) -> u32 {
    return vtex_word(vt, VTEX_HEADER_OUTLINE_PAINT);
}
