//!use vtex/footprint
//!use vtex/coverage
//!use vtex/source
// What an entry shows where nothing lies before or behind it: coverage times colour.

fn vtex_entry(vt: u32, entry: vec2u, lookup: VtexLookup) -> VtexValue {
    let c = vtex_coverage(vt, entry, lookup);
    if c <= 0.0 {
        return VtexValue(0.0);
    }
    return c * vtex_source(vt, entry.x, lookup);
}
