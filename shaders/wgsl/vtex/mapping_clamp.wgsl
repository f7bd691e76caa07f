//!use vtex/texture
//!use vtex/mapping_inset
// No texture matrix, and the address mode clamp along both axes.

fn vtex_mapping_point(vt: VtexTexture, uv: vec2f) -> vec2f {
    return uv;
}

fn vtex_mapping_axes(vt: VtexTexture, axes: vec4f) -> vec4f {
    return axes;
}

// Axes in uv, after the matrix. Beyond a side of the canvas all of a footprint shows what the side does.
fn vtex_mapping_kept(vt: VtexTexture, uv: vec2f, axes: vec4f) -> vec4f {
    let inside = clamp(uv, vec2f(0.0), vec2f(1.0)) == uv;
    return select(vec4f(0.0), axes, inside.xyxy);
}

fn vtex_mapping_address(vt: VtexTexture, uv: vec2f) -> vec2f {
    let inset = vtex_mapping_inset(vt);
    return clamp(uv, inset, 1.0 - inset);
}

fn vtex_mapping_share(vt: VtexTexture, uv: vec2f, axes: vec4f) -> f32 {
    return 1.0;
}

fn vtex_mapping_wraps(vt: VtexTexture) -> vec2<bool> {
    return vec2<bool>(false);
}
