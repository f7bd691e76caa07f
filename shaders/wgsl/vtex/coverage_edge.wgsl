//!use vtex/footprint
//!use vtex/edge
//!use vtex/ramp
// Coverage of an entry. An image fills its cell and is transparent outside its rectangle.

struct VtexCovered {
    // The entry's last item and what follows it.
    item: vec4u,
    next: u32,
    coverage: f32,
}

fn vtex_coverage(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexCovered {
    let edge = vtex_edge(vt, first, lookup);
    let coverage = vtex_ramp_coverage(vt, edge.distance, lookup.width_squared);
    return VtexCovered(edge.item, edge.next, coverage);
}

fn vtex_coverage_of_shape(covered: VtexCovered) -> f32 {
    return covered.coverage;
}
