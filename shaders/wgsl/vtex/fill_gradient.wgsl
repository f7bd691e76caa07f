//!use core/layout
//!use core/decode
//!use vtex/words
//!use vtex/footprint
//!use vtex/value
//!use vtex/gradient
// What a paint shows at a lookup: a single colour, or a gradient's.

fn vtex_fill(vt: VtexTexture, index: u32, lookup: VtexLookup) -> VtexValue {
    let paint = vtex_word4(vt, vt.paints + index * VTEX_PAINT_WORDS + VTEX_PAINT_LINEAR);
    let solid = bitcast<vec4f>(paint);
    if solid.a >= 0.0 {
        return solid;
    }
    let straight = vtex_gradient(vt, paint.x, lookup.uv);
    return vec4f(vtex_color_decode(straight.rgb) * straight.a, straight.a);
}
