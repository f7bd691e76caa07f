// No texture matrix.

fn vtex_matrix_point(vt: u32, uv: vec2f) -> vec2f {
    return uv;
}

fn vtex_matrix_axes(vt: u32, axes: vec4f) -> vec4f {
    return axes;
}
