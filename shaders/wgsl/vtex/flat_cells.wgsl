//!use vtex/cells
// The picture from cells whose lists need no frames: they draw and nothing else.

fn vtex_flat(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_cells(vt, lookup);
}
