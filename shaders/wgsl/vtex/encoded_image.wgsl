//!use core/layout
//!use core/color
//!use vtex/words
//!use vtex/footprint
//!use vtex/image
// Colour of an entry as compositing wants it: a solid paint or an image's texels.

// sRGB-encoded, premultiplied.
fn vtex_encoded(vt: u32, head: u32, lookup: VtexLookup) -> vec4f {
    let index = head & VTEX_ENTRY_INDEX_MASK;
    if (head >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_IMAGE {
        return vtex_color_encode_premultiplied(vtex_image_entry(vt, index, lookup));
    }
    let first = vtex_word(vt, VTEX_HEADER_PAINTS) + index * VTEX_PAINT_WORDS;
    let straight = vtex_word_float4(vt, first + VTEX_PAINT_ENCODED);
    return vec4f(straight.rgb * straight.a, straight.a);
}
