//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/brush_of_paint
//!use vtex/image_entry
// The colour of an entry, a paint or an image.

fn vtex_brush(vt: VtexTexture, lookup: VtexLookup, tag: u32, uv: vec2f) -> VtexBrushColor {
    let index = tag & VTEX_CMD_INDEX_MASK;
    if (tag & VTEX_CMD_KIND_MASK) == VTEX_CMD_IMAGE {
        let texel = vtex_image_entry(vt, lookup, index, uv);
        return VtexBrushColor(vtex_color_encode_premultiplied(texel), texel);
    }
    return vtex_brush_of_paint(vt, index, uv);
}
