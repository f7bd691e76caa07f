// Address modes where both are clamp.

fn vtex_address(vt: VtexTexture, uv: vec2f) -> vec2f {
    return clamp(uv, vec2f(0.0), vec2f(1.0));
}

fn vtex_address_outside(vt: VtexTexture, uv: vec2f) -> bool {
    return false;
}

fn vtex_address_wraps(vt: VtexTexture) -> vec2<bool> {
    return vec2<bool>(false);
}
