// No texture matrix.

fn vtex_matrix_point(vt: VtexTexture, uv: vec2f) -> vec2f {
    return uv;
}

fn vtex_matrix_axes(vt: VtexTexture, axes: vec4f) -> vec4f {
    return axes;
}
