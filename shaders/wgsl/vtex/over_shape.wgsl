//!use core/layout
//!use vtex/entry
//!use vtex/over_paint
// An entry composited over what lies behind it.

// Whether what lies behind the entry shows in proportion to what it leaves uncovered.
fn vtex_over_opaque(vt: VtexTexture, head: u32) -> bool {
    return (head & VTEX_ITEM_OPAQUE_BIT) != 0u;
}

// Of an entry that covers: sRGB-encoded, premultiplied.
fn vtex_over_encoded(vt: VtexTexture, entry: VtexEntry) -> vec4f {
    return vtex_encoded(vt, entry.head, entry.value);
}

fn vtex_over(vt: VtexTexture, entry: VtexEntry, behind: vec4f) -> vec4f {
    let c = entry.coverage;
    return (1.0 - c) * behind + c * vtex_over_paint(vt, entry.head, entry.value, behind);
}
