//! Twin of `vtex/image.wgsl`, and of `vtex/image_entry.wgsl`: trilinear lookups by hand. Texel centres lie at +0.5.

use super::math::{clamp, half_to_f32, to_f32, to_u32};
use super::{Lookup, Sampler};
use crate::layout::image;

/// `index`, at most one beyond `count` texels, comes back in: where it went out, or at the other side.
fn neighbour(index: f32, count: f32, wraps: bool) -> f32 {
    let kept = clamp(index, 0.0, count - 1.0);
    if wraps && kept != index {
        count - 1.0 - kept
    } else {
        kept
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

/// Four halves: linear light, premultiplied.
fn texel(sampler: &Sampler<'_>, index: u32) -> [f32; 4] {
    let [rg, ba] = sampler.words(index);
    [rg, rg >> 16, ba, ba >> 16].map(half_to_f32)
}

/// How a footprint is looked up in an image: by trilinear lookups in one level, in a row along its
/// longer principal axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Of the width in texels that each of them stands for; at least -1.
    pub(super) lod: f32,
    pub(super) places: u32,
    /// From one place to the next, in cells.
    pub(super) apart: [f32; 2],
}

impl Region {
    /// `axes` are those of a footprint in cells. The region has the footprint's covariance, as long
    /// as the longer principal axis is at most [`image::PLACES`] times the shorter one.
    pub(super) fn new([ax, ay, bx, by]: [f32; 4], texels_per_cell: f32) -> Self {
        let xx = ax * ax + bx * bx;
        let xy = ax * ay + bx * by;
        let yy = ay * ay + by * by;
        let area = ax * by - ay * bx;
        // Squares of the principal axes are eigenvalues. The shorter one follows from the area, as
        // a difference would cancel.
        let spread = ((xx - yy) * (xx - yy) + 4.0 * xy * xy).sqrt();
        let long = 0.5 * (xx + yy + spread);
        let most = to_f32(image::PLACES);
        let narrow = area * (area / long.max(1e-30));
        let short = narrow.max(long / (most * most)).max(1e-30);
        // Up to an eighth longer than wide, a single place is as good.
        let places = clamp(((long / short).sqrt() - 0.125).ceil(), 1.0, most);
        let [x, y] = if xx >= yy {
            [spread + (xx - yy), 2.0 * xy]
        } else {
            [2.0 * xy, spread + (yy - xx)]
        };
        // The variance of the places makes up for what that of one place lacks.
        let lacking = (long - short).max(0.0) / (places * places - 1.0).max(1.0);
        let factor = (lacking / (x * x + y * y).max(1e-30)).sqrt();
        let texels = short * texels_per_cell * texels_per_cell;
        Self {
            lod: 0.5 * texels.max(0.25).log2(),
            places: to_u32(places),
            apart: [x * factor, y * factor],
        }
    }
}

/// One level of an image.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// First word of its texels.
    first: u32,
    size: [u32; 2],
    /// Sides of the image in its texels: a texel at the end may lie half outside.
    sides: [f32; 2],
    wraps: [bool; 2],
}

impl Level {
    /// `value` and what the four texels around `t` in \[0, 1\] add to it.
    fn add(&self, sampler: &Sampler<'_>, value: [f32; 4], t: [f32; 2], share: f32) -> [f32; 4] {
        // Near and far neighbour along each axis.
        let mut texels = [[0; 2]; 2];
        let mut weights = [[0.0; 2]; 2];
        for axis in 0..2 {
            let count = to_f32(self.size[axis]);
            let x = t[axis] * self.sides[axis] - 0.5;
            let corner = x.floor();
            let f = x - corner;
            weights[axis] = [1.0 - f, f];
            texels[axis] =
                [corner, corner + 1.0].map(|x| to_u32(neighbour(x, count, self.wraps[axis])));
        }
        let mut value = value;
        for tap in 0..4 {
            let [near, far] = [tap & 1, tap >> 1];
            let index = texels[1][far]
                .wrapping_mul(self.size[0])
                .wrapping_add(texels[0][near]);
            let place = self
                .first
                .wrapping_add(index.wrapping_mul(image::TEXEL_WORDS));
            let texel = texel(sampler, place);
            let weight = weights[0][near] * weights[1][far] * share;
            value = std::array::from_fn(|i| value[i] + weight * texel[i]);
        }
        value
    }
}

/// `t` in \[0, 1\] over the image; `apart` is that of the region in the same measure. Level 0 is the
/// finest; the last level is kept beyond the end.
pub(super) fn filtered(
    sampler: &Sampler<'_>,
    record: u32,
    region: &Region,
    t: [f32; 2],
    apart: [f32; 2],
    wraps: [bool; 2],
) -> [f32; 4] {
    let levels = sampler.word(record.wrapping_add(image::LEVEL_COUNT));
    let coarsest = to_f32(levels.max(1) - 1);
    let finer = 0.25 * to_f32(image::FINER_QUARTERS);
    let kept = clamp(region.lod - finer, 0.0, coarsest.min(15.0));
    let finest = kept.floor();
    let coarse = weight(kept - finest);
    let full: [u32; 2] = sampler.words(record.wrapping_add(image::SIZE));
    let level = |at: u32| Level {
        first: sampler.word(record.wrapping_add(image::LEVELS).wrapping_add(at)),
        size: full.map(|side| side.wrapping_sub(1).checked_shr(at).unwrap_or(0) + 1),
        sides: full.map(|side| to_f32(side) / to_f32(1_u32.checked_shl(at).unwrap_or(1))),
        wraps,
    };
    let at = to_u32(finest);
    let levels = [(level(at), 1.0 - coarse), (level(at + 1), coarse)];
    let count = to_f32(region.places);
    let mut value = [0.0; 4];
    for place in 0..region.places {
        let from_centre = to_f32(place) - 0.5 * (count - 1.0);
        let here = [0, 1].map(|axis| t[axis] + from_centre * apart[axis]);
        for (level, share) in levels {
            if share > 0.0 {
                value = level.add(sampler, value, here, share);
            }
        }
    }
    value.map(|channel| channel / count)
}

/// In uv: left, upper, right and lower side.
pub(super) fn entry_rect(sampler: &Sampler<'_>, index: u32) -> [f32; 4] {
    let record = index.wrapping_mul(image::WORDS);
    let first = record.wrapping_add(sampler.settings.images);
    sampler.word_float4(first.wrapping_add(image::RECT_UV))
}

/// Of a patch that stands for what is not vector, or an image of the drawing, at a place inside its
/// rectangle.
pub(super) fn entry(sampler: &Sampler<'_>, index: u32, uv: [f32; 2], lookup: &Lookup) -> [f32; 4] {
    let s = &sampler.settings;
    let record = index.wrapping_mul(image::WORDS).wrapping_add(s.images);
    let rect = entry_rect(sampler, index);
    let size = [rect[2] - rect[0], rect[3] - rect[1]];
    let t = [0, 1].map(|axis| clamp((uv[axis] - rect[axis]) / size[axis], 0.0, 1.0));
    let width = to_f32(sampler.word(record.wrapping_add(image::SIZE)));
    let texels_per_cell = width / (size[0] * s.scale[0]);
    let region = Region::new(lookup.axes, texels_per_cell);
    let apart = [0, 1].map(|axis| region.apart[axis] / (s.scale[axis] * size[axis]));
    filtered(sampler, record, &region, t, apart, [false; 2])
}
