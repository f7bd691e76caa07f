//!use vtex/texture
//!use vtex/image
// How lookups without footprint mode look images up: in one place. It is what samplers do without
// anisotropy, and it costs a magnified lookup little.

// `axes` are those of a footprint in cells.
fn vtex_region(vt: VtexTexture, axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    return vtex_image_place(axes, texels_per_cell);
}

fn vtex_region_minified(vt: VtexTexture, axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    return vtex_region(vt, axes, texels_per_cell);
}
