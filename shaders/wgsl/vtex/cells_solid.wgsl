//!use core/layout
//!use vtex/cell
//!use vtex/fill
// The picture from cells that are empty or of a single colour.

fn vtex_cells(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let word = vtex_cell(vt, lookup).word;
    if (word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_EMPTY {
        return VtexValue(0.0);
    }
    return vtex_fill(vt, word & VTEX_CELL_PAYLOAD_MASK, lookup);
}
