//!use core/decode
// How a walk over groups keeps colours: sRGB-encoded, as they are composited.

fn vtex_tone_encoded(color: vec4f) -> vec4f {
    return color;
}

fn vtex_tone_linear(color: vec4f) -> vec4f {
    return vtex_color_decode_premultiplied(color);
}

// From encoded.
fn vtex_tone_of(encoded: vec4f) -> vec4f {
    return encoded;
}
