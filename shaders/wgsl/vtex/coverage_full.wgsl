//!use core/layout
//!use vtex/words
//!use vtex/footprint
// Coverage where every entry fills its cell.

struct VtexCovered {
    // The entry's only item and what follows it.
    item: vec4u,
    next: u32,
    coverage: f32,
}

fn vtex_coverage(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexCovered {
    return VtexCovered(vtex_word4(vt, first), first + VTEX_ITEM_WORDS, 1.0);
}

fn vtex_coverage_of_shape(covered: VtexCovered) -> f32 {
    return covered.coverage;
}
