//!use vtex/footprint
//!use vtex/coverage
//!use vtex/source
// What an entry and its outline show where nothing lies before or behind them.

fn vtex_entry(vt: u32, entry: vec2u, lookup: VtexLookup) -> VtexValue {
    let c = vtex_coverage_outline(vt, entry, lookup);
    var value = VtexValue(0.0);
    if c.x > 0.0 {
        value = c.x * vtex_source(vt, entry.x, lookup);
    }
    if c.y > 0.0 {
        value += c.y * vtex_source(vt, vtex_coverage_outline_head(vt), lookup);
    }
    return value;
}
