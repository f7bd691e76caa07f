//!use core/layout
//!use core/encode
//!use vtex/words
// Colour of an entry as compositing wants it: a solid paint, or what has to be encoded again.

// sRGB-encoded, premultiplied. `value` is the same colour in linear light.
fn vtex_encoded(vt: VtexTexture, head: u32, value: vec4f) -> vec4f {
    if (head & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_IMAGE {
        return vtex_color_encode_premultiplied(value);
    }
    let index = head & VTEX_ITEM_INDEX_MASK;
    let first = vt.paints + index * VTEX_PAINT_WORDS;
    let straight = vtex_word_float4(vt, first + VTEX_PAINT_ENCODED);
    if straight.a < 0.0 {
        return vtex_color_encode_premultiplied(value);
    }
    return vec4f(straight.rgb * straight.a, straight.a);
}
