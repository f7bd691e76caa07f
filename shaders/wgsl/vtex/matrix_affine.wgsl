//!use core/layout
//!use vtex/words
// The texture matrix, before the address mode.

fn vtex_matrix_linear(vt: VtexTexture, v: vec2f) -> vec2f {
    let m = vtex_word_float4(vt, VTEX_HEADER_TEXTURE_MATRIX);
    return vec2f(m.x * v.x + m.z * v.y, m.y * v.x + m.w * v.y);
}

fn vtex_matrix_point(vt: VtexTexture, uv: vec2f) -> vec2f {
    return vtex_matrix_linear(vt, uv) + vtex_word_float2(vt, VTEX_HEADER_TEXTURE_MATRIX + 4u);
}

fn vtex_matrix_axes(vt: VtexTexture, axes: vec4f) -> vec4f {
    return vec4f(vtex_matrix_linear(vt, axes.xy), vtex_matrix_linear(vt, axes.zw));
}
