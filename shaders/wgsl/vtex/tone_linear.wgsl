//!use core/decode
//!use core/encode
// How a walk over groups keeps colours: in linear light, in which ramps average them.

fn vtex_tone_encoded(color: vec4f) -> vec4f {
    return vtex_color_encode_premultiplied(color);
}

fn vtex_tone_linear(color: vec4f) -> vec4f {
    return color;
}

// From encoded.
fn vtex_tone_of(encoded: vec4f) -> vec4f {
    return vtex_color_decode_premultiplied(encoded);
}
