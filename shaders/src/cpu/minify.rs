//! Twin of `vtex/minify.wgsl`.

use super::image::{Region, filtered, weight};
use super::mapping::wraps;
use super::picture::picture;
use super::{Lookup, Sampler};
use crate::layout::filter;

/// Cells, then the raster chain, a fade of one octave between: in footprint mode from one texel of mip 0
/// to two, where the chain's bilinear interpolation blurs no more than the footprint does; in other
/// modes, whose lookups in cells have hard edges, from half a texel to one.
pub(super) fn minify(sampler: &Sampler<'_>, lookup: &Lookup) -> [f32; 4] {
    let s = &sampler.settings;
    let [ax, ay, bx, by] = lookup.axes;
    let texels = s.mip_texels_per_cell * s.mip_texels_per_cell;
    let longer = (ax * ax + ay * ay).max(bx * bx + by * by) * texels;
    // Roots and a logarithm cost as much as the rest of a magnified lookup. No region is wider than
    // its longer axis. Without a chain its texels are 0.
    if longer <= 0.25 {
        return picture(sampler, lookup, &mut ());
    }
    let region = Region::new(lookup.axes, s.mip_texels_per_cell);
    let sooner = if s.filter == filter::FOOTPRINT {
        0.0
    } else {
        1.0
    };
    let fade = weight(region.lod + sooner);
    let mut value = [0.0; 4];
    if fade < 1.0 {
        let cells = picture(sampler, lookup, &mut ());
        value = cells.map(|channel| (1.0 - fade) * channel);
    }
    if fade > 0.0 {
        let apart = [0, 1].map(|axis| region.apart[axis] / s.scale[axis]);
        let image = (s.mip_size, s.mip_last_level);
        let wraps = wraps(sampler);
        let chain = filtered(sampler, s.images, image, &region, lookup.uv, apart, wraps);
        value = std::array::from_fn(|i| value[i] + fade * chain[i]);
    }
    value
}
