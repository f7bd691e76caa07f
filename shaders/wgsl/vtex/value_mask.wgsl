// What a lookup of a mask carries: alpha alone.

alias VtexValue = f32;

fn vtex_value_alpha(value: VtexValue) -> f32 {
    return value;
}

fn vtex_value_result(vt: VtexTexture, value: VtexValue) -> vec4f {
    return vec4f(value);
}
