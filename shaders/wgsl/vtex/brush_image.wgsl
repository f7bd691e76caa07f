//!use core/color
//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/brush_of_paint
//!use vtex/image_entry
// The colour of an entry, a paint or an image.

// The samples of `mask` that the entry's brush covers: an image does inside its rectangle.
fn vtex_brush_covered(vt: VtexTexture, samples: VtexSamples, tag: u32, mask: u32) -> u32 {
    if (tag & VTEX_CMD_KIND_MASK) != VTEX_CMD_IMAGE {
        return mask;
    }
    let rect = vtex_image_entry_rect(vt, tag & VTEX_CMD_INDEX_MASK);
    return mask & vtex_samples_within(vt, samples, rect);
}

fn vtex_brush(vt: VtexTexture, lookup: VtexLookup, tag: u32, uv: vec2f) -> VtexBrushColor {
    let index = tag & VTEX_CMD_INDEX_MASK;
    if (tag & VTEX_CMD_KIND_MASK) == VTEX_CMD_IMAGE {
        let texel = vtex_image_entry(vt, lookup, index, uv);
        return VtexBrushColor(vtex_color_encode_premultiplied(texel), texel);
    }
    return vtex_brush_of_paint(vt, index, uv);
}
