//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/paint_words
// The colour of an entry, where all are solid paints.

struct VtexSource {
    // sRGB-encoded, as colours are composited, premultiplied.
    encoded: vec4f,
    // In linear light, premultiplied; its alpha is negative where it is not known.
    linear: vec4f,
}

fn vtex_source(vt: VtexTexture, lookup: VtexLookup, head: u32, uv: vec2f) -> VtexSource {
    let paint = vtex_paint_words(vt, head & VTEX_ITEM_INDEX_MASK);
    let straight = vtex_paint_unpack(paint.zw);
    let encoded = vec4f(straight.rgb * straight.a, straight.a);
    return VtexSource(encoded, vtex_paint_unpack(paint.xy));
}
