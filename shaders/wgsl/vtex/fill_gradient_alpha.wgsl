//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/value
//!use vtex/gradient
// What a paint shows at a lookup of a mask: the alpha of a single colour, or of a gradient's.

fn vtex_fill(vt: VtexTexture, index: u32, lookup: VtexLookup) -> VtexValue {
    let paint = vtex_word4(vt, vt.paints + index * VTEX_PAINT_WORDS + VTEX_PAINT_LINEAR);
    let alpha = bitcast<f32>(paint.w);
    if alpha >= 0.0 {
        return alpha;
    }
    return vtex_gradient(vt, paint.x, lookup.uv).a;
}
