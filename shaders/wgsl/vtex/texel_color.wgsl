//!use vtex/words
//!use vtex/value
// Image texels: four halves, linear light, premultiplied.

fn vtex_texel(vt: VtexTexture, index: u32) -> VtexValue {
    let words = vtex_word2(vt, index);
    return vec4f(unpack2x16float(words.x), unpack2x16float(words.y));
}
