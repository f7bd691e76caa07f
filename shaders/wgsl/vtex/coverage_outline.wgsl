//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/edge
//!use vtex/ramp
// Coverage of an entry and of the ring around it, [SFG22] eq. 2.

struct VtexCovered {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    // x: the shape, y: the ring; their sum is at most 1.
    coverage: vec2f,
}

fn vtex_coverage(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexCovered {
    let edge = vtex_edge(vt, first, lookup);
    let grown = edge.distance + vtex_word_float(vt, VTEX_HEADER_OUTLINE_WIDTH);
    let inner = vtex_ramp_coverage(vt, edge.distance, lookup.width_squared);
    let outer = vtex_ramp_coverage(vt, grown, lookup.width_squared);
    return VtexCovered(edge.item, edge.next, vec2f(inner, max(outer - inner, 0.0)));
}

fn vtex_coverage_outline_paint(vt: VtexTexture) -> u32 {
    return vtex_word(vt, VTEX_HEADER_OUTLINE_PAINT);
}

fn vtex_coverage_of_shape(covered: VtexCovered) -> f32 {
    return covered.coverage.x;
}
