//!use vtex/key
//!use vtex/texture
// Settings of the one texture this text is for: constants of its key.

fn vtex_settings_address(vt: VtexTexture) -> vec2u {
    return vec2u(VTEX_KEY_ADDRESS_U, VTEX_KEY_ADDRESS_V);
}

fn vtex_settings_has(vt: VtexTexture, feature: u32) -> bool {
    return (VTEX_KEY_FEATURES & feature) != 0u;
}
