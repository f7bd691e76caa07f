// The filter region of a lookup.

struct VtexLookup {
    // After texture matrix and address mode.
    uv: vec2f,
    // Cells a unit of uv.
    scale: vec2f,
    // Full width of the filter region; 0 is a point.
    width_cells: f32,
    // Position inside the cell, in [0, 1].
    q: vec2f,
}

fn vtex_footprint_width_cells(scale: vec2f, axes: vec4f) -> f32 {
    return max(length(scale * axes.xy), length(scale * axes.zw));
}
