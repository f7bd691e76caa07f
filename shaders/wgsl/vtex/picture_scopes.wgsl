//!use core/layout
//!use vtex/cell
//!use vtex/flat
//!use vtex/scopes
// The picture: some lists hold groups, or clips with ramps.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let cell = vtex_cell(vt, lookup);
    if (cell.word >> VTEX_CELL_TAG_SHIFT) == VTEX_CELL_SCOPES {
        return vtex_scopes(vt, lookup, cell);
    }
    return vtex_flat(vt, lookup);
}
