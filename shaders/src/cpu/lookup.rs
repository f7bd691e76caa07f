//! Twin of `vtex/lookup.wgsl`: a lookup's place and filter region.

use super::Sampler;
use super::math::clamp;

/// Cells. Fourth powers of the axes in texels are still finite, and no canvas is nearly as large.
const MOST: f32 = 1e6;

#[derive(Clone, Copy, Debug)]
pub(super) struct Lookup {
    /// After texture matrix and address mode.
    pub(super) uv: [f32; 2],
    /// Two axes of the filter region, full extents in cells; zeros are a point. No more than
    /// [`MOST`] each.
    pub(super) axes: [f32; 4],
}

impl Lookup {
    /// `axes` are in uv.
    pub(super) fn new(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> Self {
        let [x, y] = sampler.settings.scale;
        Self {
            uv,
            axes: [x * axes[0], y * axes[1], x * axes[2], y * axes[3]]
                .map(|axis| clamp(axis, -MOST, MOST)),
        }
    }
}
