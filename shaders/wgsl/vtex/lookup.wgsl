//!use vtex/texture
// A lookup's place and filter region.

struct VtexLookup {
    // After texture matrix and address mode.
    uv: vec2f,
    // Two axes of the filter region, full extents in cells; zeros are a point.
    axes: vec4f,
}

// `axes` are in uv.
fn vtex_lookup(vt: VtexTexture, uv: vec2f, axes: vec4f) -> VtexLookup {
    return VtexLookup(uv, vt.cell_from_uv.xyxy * axes);
}
