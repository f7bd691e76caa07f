//! Twin of `vtex/image.wgsl`: trilinear lookups by hand. Texel centres lie at +0.5.

use super::math::{clamp, to_f32, to_u32};
use super::{Lookup, Sampler, Value};
use crate::layout::image;

/// `index` of a texel left, right, above or below the edge comes back in.
fn neighbour(index: f32, count: f32, wraps: bool) -> f32 {
    if wraps {
        index - count * (index / count).floor()
    } else {
        clamp(index, 0.0, count - 1.0)
    }
}

/// A weight between two sides, of which the lesser is left out where it cannot be seen.
pub(super) fn weight(weight: f32) -> f32 {
    let least = 1.0 / to_f32(image::WEIGHT_STEPS);
    if weight < least {
        0.0
    } else if weight > 1.0 - least {
        1.0
    } else {
        weight
    }
}

/// `t` in \[0, 1\] over the image.
fn bilinear<V: Value>(
    sampler: &Sampler<'_>,
    record: u32,
    level: u32,
    t: [f32; 2],
    wraps: [bool; 2],
) -> V {
    let full: [u32; 2] = sampler.words(record.wrapping_add(image::SIZE));
    let size = full.map(|side| side.checked_shr(level).unwrap_or(0).max(1));
    // Near and far neighbour along each axis.
    let mut texels = [[0; 2]; 2];
    let mut weights = [[0.0; 2]; 2];
    for axis in 0..2 {
        let count = to_f32(size[axis]);
        let x = t[axis] * count - 0.5;
        let corner = x.floor();
        let f = x - corner;
        weights[axis] = [1.0 - f, f];
        texels[axis] = [corner, corner + 1.0].map(|x| to_u32(neighbour(x, count, wraps[axis])));
    }
    let first = sampler.word(record.wrapping_add(image::LEVELS).wrapping_add(level));
    let mut value = V::ZERO;
    for tap in 0..4 {
        let [near, far] = [tap & 1, tap >> 1];
        let index = texels[1][far]
            .wrapping_mul(size[0])
            .wrapping_add(texels[0][near]);
        let texel = V::texel(
            sampler,
            first.wrapping_add(index.wrapping_mul(image::TEXEL_WORDS)),
        );
        value = value.plus(texel.scaled(weights[0][near] * weights[1][far]));
    }
    value
}

/// `lod` 0 is the finest level; less is 0, and the last level is kept beyond the end.
pub(super) fn trilinear<V: Value>(
    sampler: &Sampler<'_>,
    record: u32,
    lod: f32,
    t: [f32; 2],
    wraps: [bool; 2],
) -> V {
    let count = sampler.word(record.wrapping_add(image::LEVEL_COUNT));
    let coarsest = to_f32(count.max(1) - 1);
    let kept = clamp(lod, 0.0, coarsest.min(15.0));
    let level = kept.floor();
    let coarse = weight(kept - level);
    let mut value = V::ZERO;
    for (step, weight) in [(0, 1.0 - coarse), (1, coarse)] {
        if weight > 0.0 {
            let texels: V = bilinear(sampler, record, to_u32(level) + step, t, wraps);
            value = value.plus(texels.scaled(weight));
        }
    }
    value
}

/// A patch that stands for what is not vector: nothing outside its rectangle.
pub(super) fn entry<V: Value>(sampler: &Sampler<'_>, index: u32, lookup: &Lookup) -> V {
    let s = &sampler.settings;
    let record = index.wrapping_mul(image::WORDS).wrapping_add(s.images);
    let rect = sampler.word_float4(record.wrapping_add(image::RECT_UV));
    let size = [rect[2] - rect[0], rect[3] - rect[1]];
    let t = [
        (lookup.uv[0] - rect[0]) / size[0],
        (lookup.uv[1] - rect[1]) / size[1],
    ];
    if t.iter().any(|t| *t < 0.0 || *t > 1.0) {
        return V::ZERO;
    }
    let width = to_f32(sampler.word(record.wrapping_add(image::SIZE)));
    let texels = lookup.width_cells * width / (size[0] * s.scale[0]);
    trilinear(sampler, record, texels.max(1.0).log2(), t, [false; 2])
}
