//!use core/layout
//!use vtex/settings
//!use vtex/cells
//!use vtex/clips
// The picture from cells whose lists need no frames, where of a scene's textures some have clips and
// some ramps: clips need frames only with ramps.

fn vtex_flat(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let ramps = vtex_settings_has(vt, VTEX_FEATURE_RAMPS | VTEX_FEATURE_OUTLINE);
    if vtex_settings_has(vt, VTEX_FEATURE_CLIPS) && !ramps {
        return vtex_clips(vt, lookup);
    }
    return vtex_cells(vt, lookup);
}
