// The sRGB transfer function of IEC 61966-2-1. Straight: colour as it is; premultiplied: through
// straight colour, and nothing stays nothing.

// From the scale of bytes to linear light.
fn vtex_color_decode(encoded: vec3f) -> vec3f {
    // pow of a negative base is undefined: rounding below zero must not get there.
    let c = max(encoded, vec3f(0.0));
    let high = pow((c + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

fn vtex_color_decode_premultiplied(encoded: vec4f) -> vec4f {
    if encoded.a <= 0.0 {
        return vec4f(0.0);
    }
    return vec4f(vtex_color_decode(encoded.rgb / encoded.a) * encoded.a, encoded.a);
}

// From linear light to the scale of bytes.
fn vtex_color_encode(linear_light: vec3f) -> vec3f {
    let c = max(linear_light, vec3f(0.0));
    let high = 1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055;
    return select(high, c * 12.92, c <= vec3f(0.0031308));
}

fn vtex_color_encode_premultiplied(linear_light: vec4f) -> vec4f {
    if linear_light.a <= 0.0 {
        return vec4f(0.0);
    }
    return vec4f(
        vtex_color_encode(linear_light.rgb / linear_light.a) * linear_light.a,
        linear_light.a,
    );
}
