//!use vtex/texture
// A lookup's place and filter region.

struct VtexLookup {
    // After texture matrix and address mode.
    uv: vec2f,
    // Two axes of the filter region, full extents in cells; zeros are a point. No more than
    // VTEX_LOOKUP_MOST each.
    axes: vec4f,
}

// Cells. Fourth powers of the axes in texels are still finite, and no canvas is nearly as large.
const VTEX_LOOKUP_MOST: f32 = 1e6;

// `axes` are in uv.
fn vtex_lookup(vt: VtexTexture, uv: vec2f, axes: vec4f) -> VtexLookup {
    let in_cells = vt.cell_from_uv.xyxy * axes;
    return VtexLookup(uv, clamp(in_cells, vec4f(-VTEX_LOOKUP_MOST), vec4f(VTEX_LOOKUP_MOST)));
}
