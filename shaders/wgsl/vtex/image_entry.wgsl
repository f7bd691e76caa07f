//!use core/layout
//!use vtex/words
//!use vtex/footprint
//!use vtex/image
// Raster images that entries show.

// A patch that stands for what is not vector: nothing outside its rectangle.
fn vtex_image_entry(vt: VtexTexture, index: u32, lookup: VtexLookup) -> VtexValue {
    let record = vt.images + index * VTEX_IMAGE_WORDS;
    let rect = vtex_word_float4(vt, record + VTEX_IMAGE_RECT_UV);
    let size = rect.zw - rect.xy;
    let t = (lookup.uv - rect.xy) / size;
    if any(t < vec2f(0.0)) || any(t > vec2f(1.0)) {
        return VtexValue(0.0);
    }
    let about = vtex_word4(vt, record + VTEX_IMAGE_SIZE);
    let texels_per_cell = f32(about.x) / (size.x * vt.cell_from_uv.x);
    let texels_squared = lookup.width_squared * texels_per_cell * texels_per_cell;
    let lod = 0.5 * log2(max(texels_squared, 1.0));
    return vtex_image_trilinear(vt, record, about.xy, about.z, lod, t, vec2<bool>(false));
}
