//!use vtex/footprint
//!use vtex/coverage
//!use vtex/source
// One entry of a list at a lookup.

struct VtexEntry {
    head: u32,
    coverage: f32,
    // Its colour, 0 where it does not cover.
    value: VtexValue,
}

fn vtex_entry(vt: u32, words: vec2u, lookup: VtexLookup) -> VtexEntry {
    let c = vtex_coverage(vt, words, lookup);
    var value = VtexValue(0.0);
    if c > 0.0 {
        value = vtex_source(vt, words.x, lookup);
    }
    return VtexEntry(words.x, c, value);
}

fn vtex_entry_coverage(entry: VtexEntry) -> f32 {
    return entry.coverage;
}

// What shows of it where nothing lies before or behind it.
fn vtex_entry_shown(entry: VtexEntry) -> VtexValue {
    return entry.coverage * entry.value;
}
