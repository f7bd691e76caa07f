//!use vtex/key
// Settings of the one texture this text is for: constants of its key.

fn vtex_settings_address(vt: u32) -> vec2u {
    return vec2u(VTEX_KEY_ADDRESS_U, VTEX_KEY_ADDRESS_V);
}

fn vtex_settings_texels_per_cell(vt: u32) -> u32 {
    return VTEX_KEY_TEXELS_PER_CELL;
}

fn vtex_settings_has(vt: u32, feature: u32) -> bool {
    return (VTEX_KEY_FEATURES & feature) != 0u;
}
