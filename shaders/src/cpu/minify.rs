//! Twin of `vtex/minify.wgsl`.

use super::image::{filtered, weight};
use super::mapping::wraps;
use super::picture::picture;
use super::region::minified;
use super::{Lookup, Sampler};
use crate::layout::filter;

/// Cells, then the raster chain, a fade of one octave between: in footprint mode from one texel of mip 0
/// to two, where the chain's bilinear interpolation blurs no more than the footprint does; in other
/// modes, whose lookups in cells have hard edges, from half a texel to one.
pub(super) fn minify(sampler: &Sampler<'_>, lookup: &Lookup) -> [f32; 4] {
    let s = &sampler.settings;
    let region = minified(sampler, lookup.axes, s.mip_texels_per_cell);
    let sooner = if s.filter == filter::FOOTPRINT {
        0.0
    } else {
        1.0
    };
    let fade = weight(region.lod + sooner);
    if fade == 0.0 {
        return picture(sampler, lookup, &mut ());
    }
    let mut value = [0.0; 4];
    if fade < 1.0 {
        let cells = picture(sampler, lookup, &mut ());
        value = cells.map(|channel| (1.0 - fade) * channel);
    }
    let apart = [0, 1].map(|axis| region.apart[axis] / s.scale[axis]);
    let image = (s.mip_size, s.mip_last_level);
    let wraps = wraps(sampler);
    let chain = filtered(sampler, s.images, image, &region, lookup.uv, apart, wraps);
    std::array::from_fn(|i| value[i] + fade * chain[i])
}
