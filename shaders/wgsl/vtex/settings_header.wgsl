//!use core/layout
//!use vtex/words
// Settings of any texture in the buffer: words of its header.

fn vtex_settings_address(vt: VtexTexture) -> vec2u {
    return vtex_word2(vt, VTEX_HEADER_ADDRESS_U);
}

fn vtex_settings_has(vt: VtexTexture, feature: u32) -> bool {
    return (vtex_word(vt, VTEX_HEADER_FEATURES) & feature) != 0u;
}
