//!use vtex/key
// Words of the texture that starts at word `vt`.

fn vtex_word(vt: u32, index: u32) -> u32 {
    return vtex_words[vt + index];
}

fn vtex_word2(vt: u32, index: u32) -> vec2u {
    return vec2u(vtex_words[vt + index], vtex_words[vt + index + 1u]);
}

fn vtex_word_float(vt: u32, index: u32) -> f32 {
    return bitcast<f32>(vtex_words[vt + index]);
}

fn vtex_word_float2(vt: u32, index: u32) -> vec2f {
    return bitcast<vec2f>(vtex_word2(vt, index));
}

fn vtex_word_float4(vt: u32, index: u32) -> vec4f {
    return vec4f(vtex_word_float2(vt, index), vtex_word_float2(vt, index + 2u));
}
