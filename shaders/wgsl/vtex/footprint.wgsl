//!use vtex/texture
// The filter region of a lookup.

struct VtexLookup {
    // After texture matrix and address mode.
    uv: vec2f,
    // Squared full width of the filter region in cells; 0 is a point.
    width_squared: f32,
    // Position inside the cell, in [0, 1].
    q: vec2f,
}

// Squared, because a root costs as much as a cell's walk and the mips' level does without.
fn vtex_footprint_width_squared(vt: VtexTexture, axes: vec4f) -> f32 {
    let first = vt.cell_from_uv.xy * axes.xy;
    let second = vt.cell_from_uv.xy * axes.zw;
    return max(dot(first, first), dot(second, second));
}
