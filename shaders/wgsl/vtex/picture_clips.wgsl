//!use vtex/clips
// The picture: what lists draw is clipped.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_clips(vt, lookup);
}
