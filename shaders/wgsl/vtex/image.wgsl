//!use core/layout
//!use vtex/texture
// Raster images: trilinear lookups by hand. Texel centres lie at +0.5.

// `index`, at most one beyond `count` texels, comes back in: where it went out, or at the other side.
fn vtex_image_neighbour(index: f32, count: f32, wraps: bool) -> f32 {
    let kept = clamp(index, 0.0, count - 1.0);
    return select(kept, count - 1.0 - kept, wraps && kept != index);
}

// Four halves: linear light, premultiplied.
fn vtex_image_texel(vt: VtexTexture, index: u32) -> vec4f {
    let words = vtex_word2(vt, index);
    return vec4f(unpack2x16float(words.x), unpack2x16float(words.y));
}

// A weight between two sides, of which the lesser is left out where it cannot be seen: it would
// cost as much as the other.
fn vtex_image_weight(weight: f32) -> f32 {
    let least = 1.0 / f32(VTEX_IMAGE_WEIGHT_STEPS);
    let kept = select(weight, 0.0, weight < least);
    return select(kept, 1.0, weight > 1.0 - least);
}

// How a footprint is looked up in an image: by trilinear lookups in one level, in a row along its
// longer principal axis.
struct VtexImageRegion {
    // Of the width in texels that each of them stands for; at least -1.
    lod: f32,
    places: u32,
    // From one place to the next, in cells.
    apart: vec2f,
}

// `axes` are those of a footprint in cells. The region has the footprint's covariance, as long as the
// longer principal axis is at most VTEX_IMAGE_PLACES times the shorter one.
fn vtex_image_region(axes: vec4f, texels_per_cell: f32) -> VtexImageRegion {
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

// `t` in [0, 1] over the image, of `size` texels in `levels` levels; `apart` is that of the region in
// the same measure. Level 0 is the finest; the last level is kept beyond the end. Texels are added up
// one by one: that keeps the code small where compilers run all of it for lookups that need none.
fn vtex_image_filtered(
    vt: VtexTexture,
    record: u32,
    size: vec2u,
    levels: u32,
    region: VtexImageRegion,
    t: vec2f,
    apart: vec2f,
    wraps: vec2<bool>,
) -> vec4f {
    let finer = 0.25 * f32(VTEX_IMAGE_FINER_QUARTERS);
    let kept = clamp(region.lod - finer, 0.0, min(f32(max(levels, 1u) - 1u), 15.0));
    let level = floor(kept);
    let coarse = vtex_image_weight(kept - level);
    // Four of each level, or of one.
    let first_tap = select(0u, 4u, coarse >= 1.0);
    let last_tap = select(3u, 7u, coarse > 0.0);
    let count = f32(region.places);
    var place = 0u;
    var tap = first_tap;
    var value = vec4f(0.0);
    for (var i = 0u; i < VTEX_IMAGE_TAPS * VTEX_IMAGE_PLACES; i += 1u) {
        let here = t + (f32(place) - 0.5 * (count - 1.0)) * apart;
        let at = u32(level) + (tap >> 2u);
        let row = ((size - 1u) >> vec2u(at)) + 1u;
        // A texel at the end may lie half outside of the image.
        let x = here * (vec2f(size) / f32(1u << at)) - 0.5;
        let corner = floor(x);
        let step = vec2f(f32(tap & 1u), f32((tap >> 1u) & 1u));
        // The weight of the near texel is 1 - f, that of the far one f.
        let weights = abs(1.0 - step - (x - corner));
        let weight = weights.x * weights.y * select(1.0 - coarse, coarse, tap >= 4u);
        let column = u32(vtex_image_neighbour(corner.x + step.x, f32(row.x), wraps.x));
        let line = u32(vtex_image_neighbour(corner.y + step.y, f32(row.y), wraps.y));
        let first = vtex_word(vt, record + VTEX_IMAGE_LEVELS + at);
        let texel = first + (line * row.x + column) * VTEX_IMAGE_TEXEL_WORDS;
        value += weight * vtex_image_texel(vt, texel);
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
