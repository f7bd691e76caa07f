//!use core/layout
//!use vtex/words
//!use vtex/entry
//!use vtex/over_paint
// An entry and its outline composited over what lies behind them.

// The outline's paint as the last word of an item that fills its cell.
fn vtex_over_outline_head(vt: VtexTexture) -> u32 {
    let paint = vtex_coverage_outline_paint(vt);
    let alpha = vt.paints + paint * VTEX_PAINT_WORDS + 3u;
    return select(paint, paint | VTEX_ITEM_OPAQUE_BIT, vtex_word_float(vt, alpha) >= 1.0);
}

// Whether what lies behind the entry and its outline shows in proportion to what they leave
// uncovered.
fn vtex_over_opaque(vt: VtexTexture, head: u32) -> bool {
    return (head & vtex_over_outline_head(vt) & VTEX_ITEM_OPAQUE_BIT) != 0u;
}

// Of an entry that covers, or its outline: sRGB-encoded, premultiplied.
fn vtex_over_encoded(vt: VtexTexture, entry: VtexEntry) -> vec4f {
    if entry.coverage.x > 0.0 {
        return vtex_encoded(vt, entry.head, entry.value);
    }
    return vtex_encoded(vt, vtex_over_outline_head(vt), entry.ring);
}

// Shape and ring cover different parts of the footprint: both lie over `behind`.
fn vtex_over(vt: VtexTexture, entry: VtexEntry, behind: vec4f) -> vec4f {
    let c = entry.coverage;
    let ring_head = vtex_over_outline_head(vt);
    return (1.0 - c.x - c.y) * behind
        + c.x * vtex_over_paint(vt, entry.head, entry.value, behind)
        + c.y * vtex_over_paint(vt, ring_head, entry.ring, behind);
}
