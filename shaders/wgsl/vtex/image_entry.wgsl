//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/image
//!use vtex/region
// Raster images that entries show.

// In uv: left, upper, right and lower side.
fn vtex_image_entry_rect(vt: VtexTexture, index: u32) -> vec4f {
    return vtex_word_float4(vt, vt.images + index * VTEX_IMAGE_WORDS + VTEX_IMAGE_RECT_UV);
}

// Of a patch that stands for what is not vector, or an image of the drawing, at a place inside its
// rectangle.
fn vtex_image_entry(vt: VtexTexture, lookup: VtexLookup, index: u32, uv: vec2f) -> vec4f {
    let record = vt.images + index * VTEX_IMAGE_WORDS;
    let rect = vtex_image_entry_rect(vt, index);
    let size = rect.zw - rect.xy;
    let t = clamp((uv - rect.xy) / size, vec2f(0.0), vec2f(1.0));
    let about = vtex_word4(vt, record + VTEX_IMAGE_SIZE);
    let texels = bitcast<vec2f>(about.xy);
    let texels_per_cell = texels.x / (size.x * vt.cell_from_uv.x);
    let region = vtex_region(vt, lookup.axes, texels_per_cell);
    let apart = region.apart / (vt.cell_from_uv.xy * size);
    return vtex_image_filtered(
        vt, record, texels, about.z, region, t, apart, vec2<bool>(false),
    );
}
