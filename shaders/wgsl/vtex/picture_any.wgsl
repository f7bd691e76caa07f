//!use core/layout
//!use vtex/settings
//!use vtex/cells
//!use vtex/clips
//!use vtex/scopes
// The picture where some of a scene's textures have clips, and some groups or ramps: each is walked
// in the order in which its items lie, shaders/src/spec.rs, is_composited.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    let clips = vtex_settings_has(vt, VTEX_FEATURE_CLIPS);
    let ramps = vtex_settings_has(vt, VTEX_FEATURE_RAMPS | VTEX_FEATURE_OUTLINE);
    if vtex_settings_has(vt, VTEX_FEATURE_GROUPS) || (clips && ramps) {
        return vtex_scopes(vt, lookup);
    }
    if clips {
        return vtex_clips(vt, lookup);
    }
    return vtex_cells(vt, lookup);
}
