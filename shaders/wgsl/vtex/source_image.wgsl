//!use core/layout
//!use vtex/footprint
//!use vtex/fill
//!use vtex/image_entry
// Colour of an entry: a paint or an image's texels.

fn vtex_source(vt: VtexTexture, head: u32, lookup: VtexLookup) -> VtexValue {
    let index = head & VTEX_ITEM_INDEX_MASK;
    if (head & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_IMAGE {
        return vtex_image_entry(vt, index, lookup);
    }
    return vtex_fill(vt, index, lookup);
}
