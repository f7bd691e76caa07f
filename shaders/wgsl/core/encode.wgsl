// The sRGB transfer function of IEC 61966-2-1, on straight colour: linear light to bytes' scale.

fn vtex_color_encode(linear_light: vec3f) -> vec3f {
    let c = max(linear_light, vec3f(0.0));
    let high = 1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055;
    return select(high, c * 12.92, c <= vec3f(0.0031308));
}

// Premultiplied in, premultiplied out; nothing stays nothing.
fn vtex_color_encode_premultiplied(linear_light: vec4f) -> vec4f {
    if linear_light.a <= 0.0 {
        return vec4f(0.0);
    }
    return vec4f(
        vtex_color_encode(linear_light.rgb / linear_light.a) * linear_light.a,
        linear_light.a,
    );
}
