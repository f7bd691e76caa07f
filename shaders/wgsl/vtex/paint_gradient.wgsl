//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/paint_words
//!use vtex/gradient
// Paints, where some are gradients.

// Linear light, premultiplied.
fn vtex_paint_linear(vt: VtexTexture, index: u32, uv: vec2f) -> vec4f {
    let paint = vtex_paint_linear_words(vt, index);
    if paint.y != VTEX_PAINT_GRADIENT {
        return vtex_paint_unpack(paint);
    }
    let straight = vtex_gradient(vt, paint.x, uv);
    return vec4f(vtex_color_decode(straight.rgb) * straight.a, straight.a);
}

// Of a paint's words: whether it is no single colour.
fn vtex_paint_varies(words: vec4u) -> bool {
    return words.y == VTEX_PAINT_GRADIENT;
}

// Straight, sRGB-encoded.
fn vtex_paint_straight(vt: VtexTexture, words: vec4u, uv: vec2f) -> vec4f {
    if vtex_paint_varies(words) {
        return vtex_gradient(vt, words.x, uv);
    }
    return vtex_paint_unpack(words.zw);
}
