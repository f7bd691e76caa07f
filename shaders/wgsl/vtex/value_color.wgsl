// What a lookup carries: linear light, premultiplied alpha.

alias VtexValue = vec4f;

fn vtex_value_alpha(value: VtexValue) -> f32 {
    return value.a;
}

fn vtex_value_result(vt: VtexTexture, value: VtexValue) -> vec4f {
    return value;
}
