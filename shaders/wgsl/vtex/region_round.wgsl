//!use vtex/image
// How a lookup without footprint mode looks images up: in one place, as wide as its longer axis. It is
// what samplers do without anisotropy, and it costs a magnified lookup little.

// `axes` are those of a footprint in cells.
fn vtex_region(axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    let longer = max(dot(axes.xy, axes.xy), dot(axes.zw, axes.zw));
    let lod = 0.5 * log2(max(longer * texels_per_cell * texels_per_cell, 0.25));
    return VtexImageRegion(lod, 1u, vec2f(0.0));
}

fn vtex_region_minified(axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    return vtex_region(axes, texels_per_cell);
}
