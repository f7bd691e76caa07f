//! Twin of `vtex/value_*.wgsl`: what a lookup carries, colour or a mask's alpha alone.

use super::math::half_to_f32;
use super::{Lookup, Sampler, color, composite, scopes};
use crate::layout::paint;
use vtex_format::Features;

pub(super) trait Value: Copy {
    const ZERO: Self;
    fn alpha(self) -> f32;
    fn scaled(self, factor: f32) -> Self;
    fn plus(self, other: Self) -> Self;
    /// Twin of `vtex_paint_solid`.
    fn solid(sampler: &Sampler<'_>, index: u32) -> Self;
    /// From a straight, sRGB-encoded colour.
    fn encoded(straight: [f32; 4]) -> Self;
    /// Twin of `vtex_texel`.
    fn texel(sampler: &Sampler<'_>, index: u32) -> Self;
    /// Twin of `vtex_composite`.
    fn composite(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> Self;
    /// Twin of `vtex_value_result`.
    fn result(self) -> [f32; 4];
}

/// First word of a paint.
pub(super) fn paint_first(sampler: &Sampler<'_>, index: u32) -> u32 {
    index
        .wrapping_mul(paint::WORDS)
        .wrapping_add(sampler.settings.paints)
}

/// Linear light, premultiplied alpha.
impl Value for [f32; 4] {
    const ZERO: Self = [0.0; 4];

    fn alpha(self) -> f32 {
        self[3]
    }

    fn scaled(self, factor: f32) -> Self {
        self.map(|channel| factor * channel)
    }

    fn plus(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] + other[i])
    }

    fn solid(sampler: &Sampler<'_>, index: u32) -> Self {
        sampler.word_float4(paint_first(sampler, index).wrapping_add(paint::LINEAR))
    }

    fn encoded([r, g, b, a]: [f32; 4]) -> Self {
        let [r, g, b] = color::decode([r, g, b]);
        [r * a, g * a, b * a, a]
    }

    fn texel(sampler: &Sampler<'_>, index: u32) -> Self {
        let [rg, ba] = sampler.words(index);
        [rg, rg >> 16, ba, ba >> 16].map(half_to_f32)
    }

    fn composite(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> Self {
        if sampler.settings.composited {
            scopes::scopes(sampler, first, lookup)
        } else if sampler.settings.has(Features::TRANSLUCENT) {
            composite::translucent(sampler, first, lookup)
        } else {
            composite::front(sampler, first, lookup)
        }
    }

    fn result(self) -> [f32; 4] {
        self
    }
}

/// Alpha alone.
impl Value for f32 {
    const ZERO: Self = 0.0;

    fn alpha(self) -> f32 {
        self
    }

    fn scaled(self, factor: f32) -> Self {
        factor * self
    }

    fn plus(self, other: Self) -> Self {
        self + other
    }

    fn solid(sampler: &Sampler<'_>, index: u32) -> Self {
        sampler.word_float(paint_first(sampler, index).wrapping_add(paint::LINEAR + 3))
    }

    fn encoded([.., alpha]: [f32; 4]) -> Self {
        alpha
    }

    fn texel(sampler: &Sampler<'_>, index: u32) -> Self {
        half_to_f32(sampler.word(index.wrapping_add(1)) >> 16)
    }

    fn composite(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> Self {
        composite::front(sampler, first, lookup)
    }

    fn result(self) -> [f32; 4] {
        [self; 4]
    }
}
