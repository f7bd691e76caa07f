//!use vtex/cells
// No raster chain: cells serve every footprint.

fn vtex_minify(vt: u32, lookup: VtexLookup) -> VtexValue {
    return vtex_cells(vt, lookup);
}
