//!use core/layout
//!use vtex/footprint
//!use vtex/coverage
//!use vtex/over_paint
// An entry composited over what lies behind it.

// Whether `vtex_entry` says all there is to know of the entry's colour.
fn vtex_over_opaque(vt: u32, head: u32) -> bool {
    return (head & VTEX_ENTRY_OPAQUE_BIT) != 0u;
}

// Point mode: sRGB-encoded, premultiplied, 0 where the entry does not cover.
fn vtex_over_encoded(vt: u32, entry: vec2u, lookup: VtexLookup) -> vec4f {
    if vtex_coverage(vt, entry, lookup) <= 0.0 {
        return vec4f(0.0);
    }
    return vtex_encoded(vt, entry.x, lookup);
}

fn vtex_over(vt: u32, entry: vec2u, lookup: VtexLookup, behind: vec4f) -> vec4f {
    let c = vtex_coverage(vt, entry, lookup);
    if c <= 0.0 {
        return behind;
    }
    return (1.0 - c) * behind + c * vtex_over_paint(vt, entry.x, lookup, behind);
}
