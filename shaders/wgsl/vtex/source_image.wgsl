//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/paint_words
//!use vtex/image_entry
// The colour of an entry, a solid paint or an image.

struct VtexSource {
    // sRGB-encoded, as colours are composited, premultiplied.
    encoded: vec4f,
    // In linear light, premultiplied; its alpha is negative where it is not known.
    linear: vec4f,
}

fn vtex_source(vt: VtexTexture, lookup: VtexLookup, head: u32, uv: vec2f) -> VtexSource {
    if (head & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_IMAGE {
        let texel = vtex_image_entry(vt, lookup, head & VTEX_ITEM_INDEX_MASK, uv);
        return VtexSource(vtex_color_encode_premultiplied(texel), texel);
    }
    let paint = vtex_paint_words(vt, head & VTEX_ITEM_INDEX_MASK);
    let straight = vtex_paint_unpack(paint.zw);
    let encoded = vec4f(straight.rgb * straight.a, straight.a);
    return VtexSource(encoded, vtex_paint_unpack(paint.xy));
}
