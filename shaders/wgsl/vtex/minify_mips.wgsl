//!use core/layout
//!use vtex/settings
//!use vtex/address
//!use vtex/image
//!use vtex/picture
// Cells up to half a texel of mip 0, the raster chain from one texel on, a fade between.

fn vtex_minify(vt: VtexTexture, lookup: VtexLookup) -> VtexValue {
    var lod = -1.0;
    if vtex_settings_has(vt, VTEX_FEATURE_MIPS) {
        let texels = vt.mip_texels_per_cell * vt.mip_texels_per_cell;
        lod = 0.5 * log2(max(lookup.width_squared * texels, 0.25));
    }
    // Both sides cost as much for a weight that no eye sees as for half.
    let fade = vtex_image_weight(lod + 1.0);
    var value = VtexValue(0.0);
    if fade < 1.0 {
        value = (1.0 - fade) * vtex_picture(vt, lookup);
    }
    if fade > 0.0 {
        let wraps = vtex_address_wraps(vt);
        let size = vt.mip_size;
        value += fade * vtex_image_trilinear(
            vt, vt.images, size, vt.mip_levels, lod, lookup.uv, wraps,
        );
    }
    return value;
}
