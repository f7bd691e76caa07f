//!use core/layout
//!use vtex/texture
//!use vtex/settings
//!use vtex/image
// How a footprint looks images up, in footprint mode: in as many places as it is longer than wide.

// `axes` are those of a footprint in cells. The region has the footprint's covariance, as long as the
// longer principal axis is at most VTEX_IMAGE_PLACES times the shorter one.
fn vtex_region(vt: VtexTexture, axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    // Of several textures of one text some may be looked up without it.
    if !vtex_settings_has(vt, VTEX_FEATURE_FOOTPRINT) {
        return vtex_image_place(axes, texels_per_cell);
    }
    let xx = axes.x * axes.x + axes.z * axes.z;
    let xy = axes.x * axes.y + axes.z * axes.w;
    let yy = axes.y * axes.y + axes.w * axes.w;
    let area = axes.x * axes.w - axes.y * axes.z;
    // Squares of the principal axes are eigenvalues. The shorter one follows from the area, as a
    // difference would cancel.
    let spread = sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
    let long = 0.5 * (xx + yy + spread);
    let most = f32(VTEX_IMAGE_PLACES);
    let narrow = area * (area / max(long, 1e-30));
    let short = max(max(narrow, long / (most * most)), 1e-30);
    // Up to an eighth longer than wide, a single place is as good.
    let places = clamp(ceil(sqrt(long / short) - 0.125), 1.0, most);
    let vector = select(
        vec2f(2.0 * xy, spread + (yy - xx)),
        vec2f(spread + (xx - yy), 2.0 * xy),
        xx >= yy,
    );
    // The variance of the places makes up for what that of one place lacks.
    let lacking = max(long - short, 0.0) / max(places * places - 1.0, 1.0);
    let apart = vector * sqrt(lacking / max(dot(vector, vector), 1e-30));
    let lod = 0.5 * log2(max(short * texels_per_cell * texels_per_cell, 0.25));
    return VtexImageRegion(lod, u32(places), apart);
}

// As vtex_region where that is more than half a texel long, else of a lod that no chain fades in at.
fn vtex_region_minified(vt: VtexTexture, axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    // Roots and a logarithm cost as much as the rest of a magnified lookup. No region is wider than
    // its longer axis. Without a chain its texels are 0.
    let longer = max(dot(axes.xy, axes.xy), dot(axes.zw, axes.zw));
    if longer * texels_per_cell * texels_per_cell > 0.25 {
        return vtex_region(vt, axes, texels_per_cell);
    }
    return VtexImageRegion(-1.0, 1u, vec2f(0.0));
}
