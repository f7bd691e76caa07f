//! Twin of `vtex/minify_mips.wgsl`.

use super::address::wraps;
use super::cell::cells;
use super::image::trilinear;
use super::math::{clamp, to_f32};
use super::{Lookup, Sampler, Value};
use crate::layout::image;
use vtex_format::Features;

/// Cells up to half a texel of mip 0, the raster chain from one texel on, a fade between.
pub(super) fn minify<V: Value>(sampler: &Sampler<'_>, lookup: &Lookup) -> V {
    let s = &sampler.settings;
    if !s.has(Features::MIPS) || lookup.width_cells <= 0.0 {
        return cells(sampler, lookup);
    }
    let width = to_f32(sampler.word(s.images.wrapping_add(image::SIZE)));
    let lod = (lookup.width_cells * width / s.scale[0]).max(0.5).log2();
    let fade = clamp(lod + 1.0, 0.0, 1.0);
    let mut value = V::ZERO;
    if fade < 1.0 {
        value = cells::<V>(sampler, lookup).scaled(1.0 - fade);
    }
    if fade > 0.0 {
        let chain: V = trilinear(sampler, s.images, lod, lookup.uv, wraps(sampler));
        value = value.plus(chain.scaled(fade));
    }
    value
}
