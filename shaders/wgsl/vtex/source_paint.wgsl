//!use core/layout
//!use vtex/footprint
//!use vtex/fill
// Colour of an entry where all are paints.

fn vtex_source(vt: VtexTexture, head: u32, lookup: VtexLookup) -> VtexValue {
    return vtex_fill(vt, head & VTEX_ITEM_INDEX_MASK, lookup);
}
