//!use vtex/footprint
//!use vtex/coverage
//!use vtex/paint
//!use vtex/source
// One entry of a list and its outline at a lookup.

struct VtexEntry {
    // The last word of its last item, and what follows the item.
    head: u32,
    next: u32,
    // Of the shape and of the ring.
    coverage: vec2f,
    // Their colours, 0 where they do not cover.
    value: VtexValue,
    ring: VtexValue,
}

fn vtex_entry(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexEntry {
    return vtex_entry_of(vt, vtex_coverage(vt, first, lookup), lookup);
}

fn vtex_entry_of(vt: VtexTexture, covered: VtexCovered, lookup: VtexLookup) -> VtexEntry {
    let head = covered.item.w;
    let c = covered.coverage;
    var value = VtexValue(0.0);
    if c.x > 0.0 {
        value = vtex_source(vt, head, lookup);
    }
    var ring = VtexValue(0.0);
    if c.y > 0.0 {
        ring = vtex_paint_solid(vt, vtex_coverage_outline_paint(vt));
    }
    return VtexEntry(head, covered.next, c, value, ring);
}

fn vtex_entry_coverage(entry: VtexEntry) -> f32 {
    return entry.coverage.x + entry.coverage.y;
}

// What shows of them where nothing lies before or behind them.
fn vtex_entry_shown(entry: VtexEntry) -> VtexValue {
    return entry.coverage.x * entry.value + entry.coverage.y * entry.ring;
}
