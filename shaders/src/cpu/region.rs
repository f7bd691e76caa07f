//! Twin of `vtex/region_long.wgsl` and of `vtex/region_round.wgsl`.

use super::Sampler;
use super::image::{Region, place};
use super::math::{clamp, to_f32, to_u32};
use crate::layout::{filter, image};

/// `axes` are those of a footprint in cells. In footprint mode the region has the footprint's covariance,
/// as long as the longer principal axis is at most [`image::PLACES`] times the shorter one; otherwise it
/// is one place, as wide as the longer axis.
pub(super) fn region(
    sampler: &Sampler<'_>,
    [ax, ay, bx, by]: [f32; 4],
    texels_per_cell: f32,
) -> Region {
    if sampler.settings.filter != filter::FOOTPRINT {
        return place([ax, ay, bx, by], texels_per_cell);
    }
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
    Region {
        lod: 0.5 * texels.max(0.25).log2(),
        places: to_u32(places),
        apart: [x * factor, y * factor],
    }
}

/// As [`region`] where it is more than half a texel long, else of a lod that no chain fades in at.
pub(super) fn minified(sampler: &Sampler<'_>, axes: [f32; 4], texels_per_cell: f32) -> Region {
    let [ax, ay, bx, by] = axes;
    // Roots and a logarithm cost as much as the rest of a magnified lookup. No region is wider than
    // its longer axis. Without a chain its texels are 0.
    let longer = (ax * ax + ay * ay).max(bx * bx + by * by);
    if longer * texels_per_cell * texels_per_cell > 0.25 {
        return region(sampler, axes, texels_per_cell);
    }
    Region {
        lod: -1.0,
        places: 1,
        apart: [0.0; 2],
    }
}
