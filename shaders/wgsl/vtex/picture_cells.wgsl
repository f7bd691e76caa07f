//!use vtex/cells
// The picture: lists draw and nothing else.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_cells(vt, lookup);
}
