//!use vtex/cells
// No raster chain: cells serve every footprint.

fn vtex_minify(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_cells(vt, lookup);
}
