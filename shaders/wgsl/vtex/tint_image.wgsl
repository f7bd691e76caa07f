//!use core/layout
//!use core/encode
//!use vtex/words
//!use vtex/footprint
//!use vtex/gradient
//!use vtex/image_entry
// Colour of an entry at a lookup as compositing wants it: a solid paint's, a gradient's or an
// image's.

// sRGB-encoded, premultiplied.
fn vtex_tint(vt: VtexTexture, head: u32, lookup: VtexLookup) -> vec4f {
    let index = head & VTEX_ITEM_INDEX_MASK;
    if (head & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_IMAGE {
        return vtex_color_encode_premultiplied(vtex_image_entry(vt, index, lookup));
    }
    let paint = vtex_word4(vt, vt.paints + index * VTEX_PAINT_WORDS + VTEX_PAINT_ENCODED);
    var straight = bitcast<vec4f>(paint);
    if straight.a < 0.0 {
        straight = vtex_gradient(vt, paint.x, lookup.uv);
    }
    return vec4f(straight.rgb * straight.a, straight.a);
}
