//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/paint_words
//!use vtex/gradient
// The colour of an entry, where some paints are gradients.

struct VtexSource {
    // sRGB-encoded, as colours are composited, premultiplied.
    encoded: vec4f,
    // In linear light, premultiplied; its alpha is negative where it is not known.
    linear: vec4f,
}

fn vtex_source(vt: VtexTexture, lookup: VtexLookup, head: u32, uv: vec2f) -> VtexSource {
    let paint = vtex_paint_words(vt, head & VTEX_ITEM_INDEX_MASK);
    var straight = vtex_paint_unpack(paint.zw);
    var linear = vtex_paint_unpack(paint.xy);
    if paint.y == VTEX_PAINT_GRADIENT {
        straight = vtex_gradient(vt, paint.x, uv);
        linear.a = -1.0;
    }
    return VtexSource(vec4f(straight.rgb * straight.a, straight.a), linear);
}
