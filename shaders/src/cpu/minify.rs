//! Twin of `vtex/minify_mips.wgsl`.

use super::address::wraps;
use super::cell::cells;
use super::image::{trilinear, weight};
use super::{Lookup, Sampler, Value};
use vtex_format::Features;

/// Cells up to half a texel of mip 0, the raster chain from one texel on, a fade between.
pub(super) fn minify<V: Value>(sampler: &Sampler<'_>, lookup: &Lookup) -> V {
    let s = &sampler.settings;
    let texels = lookup.width_cells * s.mip_texels_per_cell;
    // A logarithm costs as much as the rest of a magnified lookup.
    if !s.has(Features::MIPS) || texels <= 0.5 {
        return cells(sampler, lookup);
    }
    let lod = texels.log2();
    let fade = weight(lod + 1.0);
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
