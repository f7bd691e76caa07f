//!use core/layout
//!use vtex/texture
// The words of paints.

fn vtex_paint_words(vt: VtexTexture, index: u32) -> vec4u {
    return vtex_word4(vt, vt.paints + index * VTEX_PAINT_WORDS);
}

// The half for linear light. Some compilers load four words also where two are used.
fn vtex_paint_linear_words(vt: VtexTexture, index: u32) -> vec2u {
    return vtex_word2(vt, vt.paints + index * VTEX_PAINT_WORDS);
}

// A colour from two of a paint's words.
fn vtex_paint_unpack(words: vec2u) -> vec4f {
    let shares = vec4u(words.x & 0xffffu, words.x >> 16u, words.y & 0xffffu, words.y >> 16u);
    return vec4f(shares) * (1.0 / f32(VTEX_PAINT_UNIT));
}
