//!use core/layout
//!use vtex/footprint
//!use vtex/paint
//!use vtex/image
// Colour of an entry: a solid paint or an image's texels.

fn vtex_source(vt: u32, head: u32, lookup: VtexLookup) -> VtexValue {
    let index = head & VTEX_ENTRY_INDEX_MASK;
    if (head >> VTEX_ENTRY_KIND_SHIFT) == VTEX_ENTRY_IMAGE {
        return vtex_image_entry(vt, index, lookup);
    }
    return vtex_paint_solid(vt, index);
}
