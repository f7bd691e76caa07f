//!use core/layout
//!use vtex/texture
//!use vtex/paint_words
// The paint of the distance outline.

// As the tag of a command that fills its cell.
fn vtex_outline_tag(vt: VtexTexture) -> u32 {
    let paint = vtex_word(vt, VTEX_HEADER_OUTLINE_PAINT);
    let alpha = vtex_paint_linear_words(vt, paint).y >> 16u;
    return select(paint, paint | VTEX_CMD_OPAQUE_BIT, alpha == VTEX_PAINT_UNIT);
}
