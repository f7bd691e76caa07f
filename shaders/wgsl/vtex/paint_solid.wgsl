//!use vtex/texture
//!use vtex/paint_words
// Paints, where all are solid.

// Linear light, premultiplied.
fn vtex_paint_linear(vt: VtexTexture, index: u32, uv: vec2f) -> vec4f {
    return vtex_paint_unpack(vtex_paint_linear_words(vt, index));
}

// Of a paint's words: whether it is no single colour.
fn vtex_paint_varies(words: vec4u) -> bool {
    return false;
}

// Straight, sRGB-encoded.
fn vtex_paint_straight(vt: VtexTexture, words: vec4u, uv: vec2f) -> vec4f {
    return vtex_paint_unpack(words.zw);
}
