//!use vtex/texture
//!use vtex/paint_words
//!use vtex/paint
// The colour of an entry, as lists composite it.

// Premultiplied.
struct VtexBrushColor {
    // sRGB-encoded, as colours are composited.
    encoded: vec4f,
    // In linear light; its alpha is negative where it is not known.
    linear: vec4f,
}

fn vtex_brush_of_paint(vt: VtexTexture, index: u32, uv: vec2f) -> VtexBrushColor {
    let words = vtex_paint_words(vt, index);
    let straight = vtex_paint_straight(vt, words, uv);
    var linear = vtex_paint_unpack(words.xy);
    if vtex_paint_varies(words) {
        linear.a = -1.0;
    }
    return VtexBrushColor(vec4f(straight.rgb * straight.a, straight.a), linear);
}
