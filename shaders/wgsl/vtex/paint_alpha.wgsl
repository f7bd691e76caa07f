//!use core/layout
//!use vtex/words
//!use vtex/value
// Solid paints, of which a mask wants alpha alone.

fn vtex_paint_solid(vt: VtexTexture, index: u32) -> VtexValue {
    let first = vt.paints + index * VTEX_PAINT_WORDS;
    return vtex_word_float(vt, first + VTEX_PAINT_LINEAR + 3u);
}
