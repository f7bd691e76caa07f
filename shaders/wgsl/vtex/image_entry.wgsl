//!use core/layout
//!use vtex/texture
//!use vtex/lookup
//!use vtex/image
// Raster images that entries show.

// A patch that stands for what is not vector: nothing outside its rectangle.
fn vtex_image_entry(vt: VtexTexture, lookup: VtexLookup, index: u32, uv: vec2f) -> vec4f {
    let record = vt.images + index * VTEX_IMAGE_WORDS;
    let rect = vtex_word_float4(vt, record + VTEX_IMAGE_RECT_UV);
    let size = rect.zw - rect.xy;
    let t = (uv - rect.xy) / size;
    if any(t < vec2f(0.0)) || any(t > vec2f(1.0)) {
        return vec4f(0.0);
    }
    let about = vtex_word4(vt, record + VTEX_IMAGE_SIZE);
    let texels_per_cell = f32(about.x) / (size.x * vt.cell_from_uv.x);
    let region = vtex_image_region(lookup.axes, texels_per_cell);
    let apart = region.apart / (vt.cell_from_uv.xy * size);
    return vtex_image_filtered(
        vt, record, about.xy, about.z, region, t, apart, vec2<bool>(false),
    );
}
