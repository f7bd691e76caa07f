//!use core/layout
//!use vtex/words
//!use vtex/cell
//!use vtex/paint
//!use vtex/composite
// The picture from cells.

fn vtex_cells(vt: u32, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    let payload = cell.word & VTEX_CELL_PAYLOAD_MASK;
    switch cell.word >> VTEX_CELL_TAG_SHIFT {
        case VTEX_CELL_SOLID: {
            return vtex_paint_solid(vt, payload);
        }
        case VTEX_CELL_LIST: {
            let inside = VtexLookup(lookup.uv, lookup.scale, lookup.width_cells, cell.q);
            return vtex_composite(vt, vtex_word(vt, VTEX_HEADER_ENTRIES) + payload, inside);
        }
        default: {
            return VtexValue(0.0);
        }
    }
}
