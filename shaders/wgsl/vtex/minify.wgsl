//!use vtex/texture
//!use vtex/settings
//!use vtex/lookup
//!use vtex/mapping
//!use vtex/image
//!use vtex/region
//!use vtex/picture
// Cells, then the raster chain, a fade of one octave between: in footprint mode from one texel of mip 0
// to two, where the chain's bilinear interpolation blurs no more than the footprint does; in other
// modes, whose lookups in cells have hard edges, from half a texel to one.

fn vtex_minify(vt: VtexTexture, lookup: VtexLookup) -> vec4f {
    let region = vtex_region_minified(vt, lookup.axes, vt.mip_texels_per_cell);
    // Both sides cost as much for a weight that no eye sees as for half.
    let sooner = select(1.0, 0.0, vtex_settings_has(vt, VTEX_FEATURE_FOOTPRINT));
    let fade = vtex_image_weight(region.lod + sooner);
    var value = vec4f(0.0);
    if fade < 1.0 {
        value = (1.0 - fade) * vtex_picture(vt, lookup);
    }
    if fade > 0.0 {
        let wraps = vtex_mapping_wraps(vt);
        let apart = region.apart / vt.cell_from_uv.xy;
        value += fade * vtex_image_filtered(
            vt, vt.images, vt.mip_size, vt.mip_last_level, region, lookup.uv, apart, wraps,
        );
    }
    return value;
}
