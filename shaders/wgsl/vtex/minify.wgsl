//!use vtex/texture
//!use vtex/settings
//!use vtex/lookup
//!use vtex/mapping
//!use vtex/image
//!use vtex/picture
// Cells, then the raster chain, a fade of one octave between: in footprint mode from one texel of mip 0
// to two, where the chain's bilinear interpolation blurs no more than the footprint does; in other
// modes, whose lookups in cells have hard edges, from half a texel to one.

fn vtex_minify(vt: VtexTexture, lookup: VtexLookup) -> vec4f {
    let axes = lookup.axes;
    let texels = vt.mip_texels_per_cell * vt.mip_texels_per_cell;
    // Roots and a logarithm cost as much as the rest of a magnified lookup. No region is wider than
    // its longer axis. Without a chain its texels are 0.
    let longer = max(dot(axes.xy, axes.xy), dot(axes.zw, axes.zw)) * texels;
    var region = VtexImageRegion(-1.0, 1u, vec2f(0.0));
    if longer > 0.25 {
        region = vtex_image_region(axes, vt.mip_texels_per_cell);
    }
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
