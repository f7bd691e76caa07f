//!use core/layout
//!use vtex/footprint
//!use vtex/paint
// Colour of an entry where all are solid paints.

fn vtex_source(vt: VtexTexture, head: u32, lookup: VtexLookup) -> VtexValue {
    return vtex_paint_solid(vt, head & VTEX_ITEM_INDEX_MASK);
}
