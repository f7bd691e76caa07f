//!use vtex/clips
// The picture from cells whose lists need no frames: what they draw may be clipped.

fn vtex_flat(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    return vtex_clips(vt, lookup);
}
