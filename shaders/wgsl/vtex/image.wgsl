//!use core/layout
//!use vtex/texture
// Raster images. The sampler interpolates between the texels of a level; levels and places are mixed here.

// A weight between two sides, of which the lesser is left out where it cannot be seen: it would
// cost as much as the other.
fn vtex_image_weight(weight: f32) -> f32 {
    let least = 1.0 / f32(VTEX_IMAGE_WEIGHT_STEPS);
    let kept = select(weight, 0.0, weight < least);
    return select(kept, 1.0, weight > 1.0 - least);
}

// How a footprint is looked up in an image: by trilinear lookups of one lod, in a row along its
// longer principal axis.
struct VtexImageRegion {
    // Of the width in texels that each of them stands for; at least -1.
    lod: f32,
    places: u32,
    // From one place to the next, in cells.
    apart: vec2f,
}

// One place, as wide as the longer of the axes, which are those of a footprint in cells.
fn vtex_image_place(axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
    let longer = max(dot(axes.xy, axes.xy), dot(axes.zw, axes.zw));
    let lod = 0.5 * log2(max(longer * texels_per_cell * texels_per_cell, 0.25));
    return VtexImageRegion(lod, 1u, vec2f(0.0));
}

// `t` in [0, 1] over the image, whose record has this size and last level; `apart` is that of the region
// in the same measure. Level 0 is the finest; the last level is kept beyond the end. A place beyond a
// side is moved to the side, or comes back in at the other where the image wraps; the texels around a
// level show what lies there.
fn vtex_image_filtered(
    vt: VtexTexture,
    record: u32,
    size: vec2f,
    last_level: u32,
    region: VtexImageRegion,
    t: vec2f,
    apart: vec2f,
    wraps: vec2<bool>,
) -> vec4f {
    let finer = 0.25 * f32(VTEX_IMAGE_FINER_QUARTERS);
    let kept = clamp(region.lod - finer, 0.0, f32(min(last_level, 15u)));
    let level = floor(kept);
    let coarse = vtex_image_weight(kept - level);
    // Behind the last level there is none, and it has no weight.
    let levels = vtex_word2(vt, record + VTEX_IMAGE_LEVELS + u32(level));
    let texel_size = 1.0 / vec2f(textureDimensions(vtex_texels));
    // Of the finer level: the size over 2 to the level.
    let texels = size * bitcast<f32>((127u - u32(level)) << 23u);
    // One of each level, or of one.
    let first_tap = select(0u, 1u, coarse >= 1.0);
    let last_tap = select(0u, 1u, coarse > 0.0);
    let count = f32(region.places);
    var place = 0u;
    var tap = first_tap;
    var value = vec4f(0.0);
    for (var i = 0u; i < VTEX_IMAGE_TAPS * VTEX_IMAGE_PLACES; i += 1u) {
        let here = t + (f32(place) - 0.5 * (count - 1.0)) * apart;
        let inside = select(clamp(here, vec2f(0.0), vec2f(1.0)), here - floor(here), wraps);
        let is_coarse = tap == 1u;
        let word = select(levels.x, levels.y, is_coarse);
        let corner = vec2u(word, word >> VTEX_IMAGE_Y_SHIFT) & vec2u(VTEX_IMAGE_X_MASK);
        let at = vec2f(corner) + inside * texels * select(1.0, 0.5, is_coarse);
        let texel = textureSampleLevel(
            vtex_texels, vtex_sampler, at * texel_size, word >> VTEX_IMAGE_PAGE_SHIFT, 0.0,
        );
        value += select(1.0 - coarse, coarse, is_coarse) * texel;
        if tap == last_tap {
            place += 1u;
            if place >= region.places {
                break;
            }
        }
        tap = select(tap + 1u, first_tap, tap == last_tap);
    }
    return value / count;
}
