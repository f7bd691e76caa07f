//! Twin of `vtex/brush_*.wgsl`: the colour of an entry, as lists composite it.

use super::samples::Samples;
use super::{Lookup, Sampler, color, image, paint};
use crate::layout::cmd;

/// Premultiplied.
#[derive(Clone, Copy, Debug)]
pub(super) struct BrushColor {
    /// sRGB-encoded, as colours are composited.
    pub(super) encoded: [f32; 4],
    /// In linear light; its alpha is negative where it is not known.
    pub(super) linear: [f32; 4],
}

/// The samples of `mask` that the entry's brush covers: a paint does everywhere, and an image inside
/// its rectangle.
pub(super) fn covered<S: Samples>(sampler: &Sampler<'_>, samples: &S, tag: u32, mask: u32) -> u32 {
    if mask == 0 || tag & cmd::KIND_MASK != cmd::IMAGE {
        return mask;
    }
    let rect = image::entry_rect(sampler, tag & cmd::INDEX_MASK);
    mask & samples.within(sampler, rect)
}

pub(super) fn brush(sampler: &Sampler<'_>, tag: u32, uv: [f32; 2], lookup: &Lookup) -> BrushColor {
    let index = tag & cmd::INDEX_MASK;
    if tag & cmd::KIND_MASK == cmd::IMAGE {
        let linear = image::entry(sampler, index, uv, lookup);
        return BrushColor {
            encoded: color::encode_premultiplied(linear),
            linear,
        };
    }
    of_paint(sampler, index, uv)
}

fn of_paint(sampler: &Sampler<'_>, index: u32, uv: [f32; 2]) -> BrushColor {
    let words = paint::words(sampler, index);
    let [r, g, b, a] = paint::straight(sampler, words, uv);
    let mut linear = paint::unpack([words[0], words[1]]);
    if paint::varies(words) {
        linear[3] = -1.0;
    }
    BrushColor {
        encoded: [r * a, g * a, b * a, a],
        linear,
    }
}
