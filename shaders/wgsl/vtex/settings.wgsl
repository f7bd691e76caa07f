//!use vtex/key
//!use vtex/texture
// What a texture needs: the key says what a text has code for, the header which of it a texture uses.

fn vtex_settings_has(vt: VtexTexture, feature: u32) -> bool {
    // In this order: what the key lacks is false before the shader runs.
    return (vt.features & (VTEX_KEY_FEATURES & feature)) != 0u;
}
