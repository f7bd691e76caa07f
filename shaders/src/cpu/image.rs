//! Twin of `vtex/image.wgsl`, and of `vtex/image_entry.wgsl`; here with what the sampler does there.

use super::math::{clamp, to_f32, to_u32};
use super::region::region;
use super::{Lookup, Sampler};
use crate::layout::image;

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

/// How a footprint is looked up in an image: by trilinear lookups of one lod, in a row along its
/// longer principal axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Of the width in texels that each of them stands for; at least -1.
    pub(super) lod: f32,
    pub(super) places: u32,
    /// From one place to the next, in cells.
    pub(super) apart: [f32; 2],
}

/// One place, as wide as the longer of the axes, which are those of a footprint in cells.
pub(super) fn place([ax, ay, bx, by]: [f32; 4], texels_per_cell: f32) -> Region {
    let longer = (ax * ax + ay * ay).max(bx * bx + by * by);
    let texels = longer * texels_per_cell * texels_per_cell;
    Region {
        lod: 0.5 * texels.max(0.25).log2(),
        places: 1,
        apart: [0.0; 2],
    }
}

/// One level of an image.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// [`image::LEVELS`].
    word: u32,
    /// Texels that the image's sides are from each other.
    texels: [f32; 2],
}

impl Level {
    /// At a place in \[0, 1\] over the image.
    fn sample(&self, sampler: &Sampler<'_>, inside: [f32; 2]) -> [f32; 4] {
        let corner = [self.word, self.word >> image::Y_SHIFT].map(|at| at & image::X_MASK);
        let at = [0, 1].map(|axis| to_f32(corner[axis]) + inside[axis] * self.texels[axis]);
        bilinear(sampler, self.word >> image::PAGE_SHIFT, at)
    }
}

/// What a bilinear sample with sRGB decoding returns at a place in texels, whose centres lie at +0.5.
fn bilinear(sampler: &Sampler<'_>, page: u32, place: [f32; 2]) -> [f32; 4] {
    let from_centre = place.map(|at| (at - 0.5).max(0.0));
    let corner = from_centre.map(f32::floor);
    let [fx, fy] = [0, 1].map(|axis| from_centre[axis] - corner[axis]);
    let [x, y] = corner.map(to_u32);
    let [right, below] = [x, y].map(|at| at.saturating_add(1));
    let texel = |x, y| {
        let [r, g, b, a] = sampler.texels.texel(page, x, y);
        let [r, g, b] = [r, g, b].map(|code| sampler.decode[usize::from(code)]);
        [r, g, b, f32::from(a) / 255.0]
    };
    let mix = |a: [f32; 4], b: [f32; 4], t: f32| -> [f32; 4] {
        std::array::from_fn(|i| a[i] + t * (b[i] - a[i]))
    };
    let upper = mix(texel(x, y), texel(right, y), fx);
    let lower = mix(texel(x, below), texel(right, below), fx);
    mix(upper, lower, fy)
}

/// `t` in \[0, 1\] over the image, whose record has this size and last level; `apart` is that of the
/// region in the same measure. Level 0 is the finest; the last level is kept beyond the end. A place
/// beyond a side is moved to the side, or comes back in at the other where the image wraps.
pub(super) fn filtered(
    sampler: &Sampler<'_>,
    record: u32,
    (size, last_level): ([f32; 2], u32),
    region: &Region,
    t: [f32; 2],
    apart: [f32; 2],
    wraps: [bool; 2],
) -> [f32; 4] {
    let finer = 0.25 * to_f32(image::FINER_QUARTERS);
    let kept = clamp(region.lod - finer, 0.0, to_f32(last_level.min(15)));
    let finest = kept.floor();
    let coarse = weight(kept - finest);
    let at = to_u32(finest);
    let first = record.wrapping_add(image::LEVELS).wrapping_add(at);
    let part = f32::from_bits((127 - at) << 23);
    let level = |tap: u32, part: f32| Level {
        word: sampler.word(first.wrapping_add(tap)),
        texels: size.map(|side| side * part),
    };
    let levels = [
        (level(0, part), 1.0 - coarse),
        (level(1, part * 0.5), coarse),
    ];
    let count = to_f32(region.places);
    let mut value = [0.0; 4];
    for place in 0..region.places {
        let from_centre = to_f32(place) - 0.5 * (count - 1.0);
        let inside = [0, 1].map(|axis| {
            let here = t[axis] + from_centre * apart[axis];
            if wraps[axis] {
                here - here.floor()
            } else {
                clamp(here, 0.0, 1.0)
            }
        });
        for (level, share) in levels {
            if share > 0.0 {
                let texel = level.sample(sampler, inside);
                value = std::array::from_fn(|i| value[i] + share * texel[i]);
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
    let [width, height, last_level, _] = sampler.words(record.wrapping_add(image::SIZE));
    let texels = [width, height].map(f32::from_bits);
    let texels_per_cell = texels[0] / (size[0] * s.scale[0]);
    let region = region(sampler, lookup.axes, texels_per_cell);
    let apart = [0, 1].map(|axis| region.apart[axis] / (s.scale[axis] * size[axis]));
    let image = (texels, last_level);
    filtered(sampler, record, image, &region, t, apart, [false; 2])
}
