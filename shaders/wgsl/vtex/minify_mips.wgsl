//!use core/layout
//!use vtex/words
//!use vtex/settings
//!use vtex/address
//!use vtex/image
//!use vtex/cells
// Cells up to half a texel of mip 0, the raster chain from one texel on, a fade between.

fn vtex_minify(vt: u32, lookup: VtexLookup) -> VtexValue {
    let record = vtex_word(vt, VTEX_HEADER_IMAGES);
    var lod = -1.0;
    if vtex_settings_has(vt, VTEX_FEATURE_MIPS) {
        let width = f32(vtex_word(vt, record + VTEX_IMAGE_SIZE));
        lod = log2(max(lookup.width_cells * width / lookup.scale.x, 0.5));
    }
    let fade = clamp(lod + 1.0, 0.0, 1.0);
    var value = VtexValue(0.0);
    if fade < 1.0 {
        value = (1.0 - fade) * vtex_cells(vt, lookup);
    }
    if fade > 0.0 {
        let wraps = vtex_address_wraps(vt);
        value += fade * vtex_image_trilinear(vt, record, lod, lookup.uv, wraps);
    }
    return value;
}
