// The sRGB transfer function of IEC 61966-2-1, on straight colour: bytes' scale to linear light.

fn vtex_color_decode(encoded: vec3f) -> vec3f {
    // pow of a negative base is undefined: rounding below zero must not get there.
    let c = max(encoded, vec3f(0.0));
    let high = pow((c + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

// Premultiplied in, premultiplied out; nothing stays nothing.
fn vtex_color_decode_premultiplied(encoded: vec4f) -> vec4f {
    if encoded.a <= 0.0 {
        return vec4f(0.0);
    }
    return vec4f(vtex_color_decode(encoded.rgb / encoded.a) * encoded.a, encoded.a);
}
