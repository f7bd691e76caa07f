//!use core/layout
//!use vtex/words
// Colour of an entry as compositing wants it where all are solid paints.

// sRGB-encoded, premultiplied. `value` is the same colour in linear light.
fn vtex_encoded(vt: VtexTexture, head: u32, value: vec4f) -> vec4f {
    let index = head & VTEX_ITEM_INDEX_MASK;
    let first = vt.paints + index * VTEX_PAINT_WORDS;
    let straight = vtex_word_float4(vt, first + VTEX_PAINT_ENCODED);
    return vec4f(straight.rgb * straight.a, straight.a);
}
