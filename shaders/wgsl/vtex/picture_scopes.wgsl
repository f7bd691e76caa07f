//!use vtex/scopes
// The picture: lists hold groups, or clips with ramps.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_scopes(vt, lookup);
}
