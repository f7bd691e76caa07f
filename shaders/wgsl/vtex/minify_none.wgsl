//!use vtex/picture
// No raster chain: cells serve every footprint.

fn vtex_minify(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_picture(vt, lookup);
}
