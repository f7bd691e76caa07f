//!use core/layout
//!use core/color
//!use vtex/words
// Colour of an entry as compositing wants it: a solid paint or an image's texels.

// sRGB-encoded, premultiplied. `value` is the same colour in linear light.
fn vtex_encoded(vt: u32, head: u32, value: vec4f) -> vec4f {
    if (head >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_IMAGE {
        return vtex_color_encode_premultiplied(value);
    }
    let index = head & VTEX_ENTRY_INDEX_MASK;
    let first = vtex_word(vt, VTEX_HEADER_PAINTS) + index * VTEX_PAINT_WORDS;
    let straight = vtex_word_float4(vt, first + VTEX_PAINT_ENCODED);
    return vec4f(straight.rgb * straight.a, straight.a);
}
