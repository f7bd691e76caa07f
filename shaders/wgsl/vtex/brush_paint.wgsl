//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/samples
//!use vtex/brush_of_paint
// The colour of an entry, where all have paints.

// The samples of `mask` that the entry's brush covers: a paint does everywhere.
fn vtex_brush_covered(vt: VtexTexture, samples: VtexSamples, tag: u32, mask: u32) -> u32 {
    return mask;
}

fn vtex_brush(vt: VtexTexture, lookup: VtexLookup, tag: u32, uv: vec2f) -> VtexBrushColor {
    return vtex_brush_of_paint(vt, tag & VTEX_CMD_INDEX_MASK, uv);
}
