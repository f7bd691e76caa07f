//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/source_of_paint
// The colour of an entry, where all have paints.

fn vtex_source(vt: VtexTexture, lookup: VtexLookup, head: u32, uv: vec2f) -> VtexSource {
    return vtex_source_of_paint(vt, head & VTEX_CMD_INDEX_MASK, uv);
}
