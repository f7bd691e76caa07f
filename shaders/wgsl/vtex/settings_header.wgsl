//!use core/layout
//!use vtex/words
// Settings of any texture in the buffer: words of its header.

fn vtex_settings_address(vt: u32) -> vec2u {
    return vtex_word2(vt, VTEX_HEADER_ADDRESS_U);
}

fn vtex_settings_texels_per_cell(vt: u32) -> u32 {
    return vtex_word(vt, VTEX_HEADER_TEXELS_PER_CELL);
}

fn vtex_settings_has(vt: u32, feature: u32) -> bool {
    return (vtex_word(vt, VTEX_HEADER_FEATURES) & feature) != 0u;
}
