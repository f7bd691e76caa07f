//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/brush_of_paint
// The colour of an entry, where all have paints.

fn vtex_brush(vt: VtexTexture, lookup: VtexLookup, tag: u32, uv: vec2f) -> VtexBrushColor {
    return vtex_brush_of_paint(vt, tag & VTEX_CMD_INDEX_MASK, uv);
}
