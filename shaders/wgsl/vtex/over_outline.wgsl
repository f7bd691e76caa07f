//!use core/layout
//!use vtex/footprint
//!use vtex/coverage
//!use vtex/over_paint
// An entry and its outline composited over what lies behind them.

// Whether `vtex_entry` says all there is to know of the entry's colour and its outline's.
fn vtex_over_opaque(vt: u32, head: u32) -> bool {
    return (head & vtex_coverage_outline_head(vt) & VTEX_ENTRY_OPAQUE_BIT) != 0u;
}

// Point mode: sRGB-encoded, premultiplied, 0 where neither covers.
fn vtex_over_encoded(vt: u32, entry: vec2u, lookup: VtexLookup) -> vec4f {
    let c = vtex_coverage_outline(vt, entry, lookup);
    if c.x > 0.0 {
        return vtex_encoded(vt, entry.x, lookup);
    }
    if c.y > 0.0 {
        return vtex_encoded(vt, vtex_coverage_outline_head(vt), lookup);
    }
    return vec4f(0.0);
}

fn vtex_over(vt: u32, entry: vec2u, lookup: VtexLookup, behind: vec4f) -> vec4f {
    let c = vtex_coverage_outline(vt, entry, lookup);
    var color = (1.0 - c.x - c.y) * behind;
    if c.x > 0.0 {
        color += c.x * vtex_over_paint(vt, entry.x, lookup, behind);
    }
    if c.y > 0.0 {
        color += c.y * vtex_over_paint(vt, vtex_coverage_outline_head(vt), lookup, behind);
    }
    return color;
}
