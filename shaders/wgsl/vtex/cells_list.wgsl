//!use core/layout
//!use vtex/cell
//!use vtex/fill
//!use vtex/composite
// The picture from cells where edges are ramps.

fn vtex_cells(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    switch cell.word >> VTEX_CELL_TAG_SHIFT {
        case VTEX_CELL_SOLID: {
            return vtex_fill(vt, payload, lookup);
        }
        case VTEX_CELL_LIST: {
            let inside = VtexLookup(lookup.uv, lookup.width_squared, cell.q);
            return vtex_composite(vt, vt.items + payload * VTEX_ITEM_WORDS, inside);
        }
        default: {
            return VtexValue(0.0);
        }
    }
}
