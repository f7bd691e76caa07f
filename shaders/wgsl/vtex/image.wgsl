//!use core/layout
//!use vtex/words
//!use vtex/texel
// Raster images: trilinear lookups by hand. Texel centres lie at +0.5.

// `index` of a texel left, right, above or below the edge comes back in.
fn vtex_image_neighbour(index: f32, count: f32, wraps: bool) -> f32 {
    let wrapped = index - count * floor(index / count);
    return select(clamp(index, 0.0, count - 1.0), wrapped, wraps);
}

// A weight between two sides, of which the lesser is left out where it cannot be seen: it would
// cost as much as the other.
fn vtex_image_weight(weight: f32) -> f32 {
    let least = 1.0 / f32(VTEX_IMAGE_WEIGHT_STEPS);
    let kept = select(weight, 0.0, weight < least);
    return select(kept, 1.0, weight > 1.0 - least);
}

// `t` in [0, 1] over the image, of `size` texels in `levels` levels. `lod` 0 is the finest; less is
// 0, and the last level is kept beyond the end. Texels are added up one by one: that keeps the
// code small where compilers run all of it for lookups that need none of it.
fn vtex_image_trilinear(
    vt: VtexTexture,
    record: u32,
    size: vec2u,
    levels: u32,
    lod: f32,
    t: vec2f,
    wraps: vec2<bool>,
) -> VtexValue {
    let kept = clamp(lod, 0.0, min(f32(max(levels, 1u) - 1u), 15.0));
    let level = floor(kept);
    let coarse = vtex_image_weight(kept - level);
    // Four of each level, or of one.
    let first_tap = select(0u, 4u, coarse >= 1.0);
    let last_tap = select(3u, 7u, coarse > 0.0);
    var value = VtexValue(0.0);
    for (var i = 0u; i < VTEX_IMAGE_TAPS; i += 1u) {
        let tap = first_tap + i;
        let at = u32(level) + (tap >> 2u);
        let row = max(size >> vec2u(at), vec2u(1u));
        let x = t * vec2f(row) - 0.5;
        let corner = floor(x);
        let step = vec2f(f32(tap & 1u), f32((tap >> 1u) & 1u));
        // The weight of the near texel is 1 - f, that of the far one f.
        let weights = abs(1.0 - step - (x - corner));
        let weight = weights.x * weights.y * select(1.0 - coarse, coarse, tap >= 4u);
        let column = u32(vtex_image_neighbour(corner.x + step.x, f32(row.x), wraps.x));
        let line = u32(vtex_image_neighbour(corner.y + step.y, f32(row.y), wraps.y));
        let first = vtex_word(vt, record + VTEX_IMAGE_LEVELS + at);
        let texel = first + (line * row.x + column) * VTEX_IMAGE_TEXEL_WORDS;
        value += weight * vtex_texel(vt, texel);
        if tap == last_tap {
            break;
        }
    }
    return value;
}
