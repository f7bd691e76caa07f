//!use vtex/flat
// The picture: lists need no frames.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_flat(vt, lookup);
}
