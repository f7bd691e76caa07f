//!use vtex/footprint
//!use vtex/coverage
//!use vtex/source
// One entry of a list at a lookup.

struct VtexEntry {
    // The last word of its last item, and what follows the item.
    head: u32,
    next: u32,
    coverage: f32,
    // Its colour, 0 where it does not cover.
    value: VtexValue,
}

fn vtex_entry(vt: VtexTexture, first: u32, lookup: VtexLookup) -> VtexEntry {
    return vtex_entry_of(vt, vtex_coverage(vt, first, lookup), lookup);
}

fn vtex_entry_of(vt: VtexTexture, covered: VtexCovered, lookup: VtexLookup) -> VtexEntry {
    let head = covered.item.w;
    var value = VtexValue(0.0);
    if covered.coverage > 0.0 {
        value = vtex_source(vt, head, lookup);
    }
    return VtexEntry(head, covered.next, covered.coverage, value);
}

fn vtex_entry_coverage(entry: VtexEntry) -> f32 {
    return entry.coverage;
}

// What shows of it where nothing lies before or behind it.
fn vtex_entry_shown(entry: VtexEntry) -> VtexValue {
    return entry.coverage * entry.value;
}
