//!use vtex/words
//!use vtex/value
// Image texels, of which a mask wants alpha alone.

fn vtex_texel(vt: VtexTexture, index: u32) -> VtexValue {
    return unpack2x16float(vtex_word(vt, index + 1u)).y;
}
