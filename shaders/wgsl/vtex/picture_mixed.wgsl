//!use core/layout
//!use vtex/settings
//!use vtex/cells
//!use vtex/scopes
// The picture where some of a scene's textures have groups.

fn vtex_picture(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    if vtex_settings_has(vt, VTEX_FEATURE_GROUPS) {
        return vtex_scopes(vt, lookup);
    }
    return vtex_cells(vt, lookup);
}
