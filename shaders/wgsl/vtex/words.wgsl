//!use vtex/texture
// Words of a texture.

fn vtex_word(vt: VtexTexture, index: u32) -> u32 {
    let word = vt.first + index;
    return vtex_words[word >> 2u][word & 3u];
}

fn vtex_word2(vt: VtexTexture, index: u32) -> vec2u {
    return vec2u(vtex_word(vt, index), vtex_word(vt, index + 1u));
}

// Four words in one load: `index` is a multiple of four.
fn vtex_word4(vt: VtexTexture, index: u32) -> vec4u {
    return vtex_words[(vt.first + index) >> 2u];
}

fn vtex_word_float(vt: VtexTexture, index: u32) -> f32 {
    return bitcast<f32>(vtex_word(vt, index));
}

fn vtex_word_float2(vt: VtexTexture, index: u32) -> vec2f {
    return bitcast<vec2f>(vtex_word2(vt, index));
}

fn vtex_word_float4(vt: VtexTexture, index: u32) -> vec4f {
    return bitcast<vec4f>(vtex_word4(vt, index));
}
