//! Twin of `vtex/paint_*.wgsl`: solid paints and gradients.

use super::math::to_f32;
use super::{Sampler, color, gradient};
use crate::layout::paint;

/// The words of a paint.
pub(super) fn words(sampler: &Sampler<'_>, index: u32) -> [u32; 4] {
    let offset = index.wrapping_mul(paint::WORDS);
    sampler.words(offset.wrapping_add(sampler.settings.paints))
}

/// A colour from two of a paint's words.
pub(super) fn unpack([first, second]: [u32; 2]) -> [f32; 4] {
    [first & 0xffff, first >> 16, second & 0xffff, second >> 16]
        .map(|share| to_f32(share) * (1.0 / to_f32(paint::UNIT)))
}

/// Linear light, premultiplied.
pub(super) fn linear(sampler: &Sampler<'_>, index: u32, uv: [f32; 2]) -> [f32; 4] {
    let [first, second, ..] = words(sampler, index);
    if second != paint::GRADIENT {
        return unpack([first, second]);
    }
    let [r, g, b, a] = gradient::gradient(sampler, first, uv);
    let [r, g, b] = color::decode([r, g, b]);
    [r * a, g * a, b * a, a]
}

/// Of a paint's words: whether it is no single colour.
pub(super) const fn varies([_, second, ..]: [u32; 4]) -> bool {
    second == paint::GRADIENT
}

/// Straight, sRGB-encoded.
pub(super) fn straight(sampler: &Sampler<'_>, words: [u32; 4], uv: [f32; 2]) -> [f32; 4] {
    if varies(words) {
        return gradient::gradient(sampler, words[0], uv);
    }
    unpack([words[2], words[3]])
}
