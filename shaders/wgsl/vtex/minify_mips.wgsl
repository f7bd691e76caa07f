//!use core/layout
//!use vtex/words
//!use vtex/settings
//!use vtex/address
//!use vtex/image
//!use vtex/cells
// Cells up to half a texel of mip 0, the raster chain from one texel on, a fade between.

fn vtex_minify(vt: u32, lookup: VtexLookup) -> VtexValue {
    if !vtex_settings_has(vt, VTEX_FEATURE_MIPS) {
        return vtex_cells(vt, lookup);
    }
    let record = vtex_word(vt, VTEX_HEADER_IMAGES);
    let width = f32(vtex_word(vt, record + VTEX_IMAGE_SIZE));
    let texels = lookup.width_cells * width / lookup.scale.x;
    if texels <= 0.5 {
        return vtex_cells(vt, lookup);
    }
    let lod = log2(texels);
    let fade = clamp(lod + 1.0, 0.0, 1.0);
    let image = vtex_image_trilinear(vt, record, lod, lookup.uv, vtex_address_wraps(vt));
    if fade >= 1.0 {
        return image;
    }
    return (1.0 - fade) * vtex_cells(vt, lookup) + fade * image;
}
