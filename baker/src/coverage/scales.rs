//! Distances of a bake.

use crate::{
    config::BakeConfig,
    coverage::{classify::Distances, grid::Lattice},
    drawing::to_f32,
};

/// Steps beyond half the range within which an edge still takes part in a tile: bilinear lookups
/// near an edge mix texels that lie up to a diagonal further off.
const REACH_BEYOND_RANGE: f64 = 1.5;
/// Steps by which evaluators' f32 arithmetic may misplace a lookup, with room to spare.
const ROUNDING_MARGIN: f64 = 0.01;

/// Distances of this bake, in steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// Full width of the stored distances.
    pub(crate) range: f64,
    /// At which edges concern cells.
    pub(crate) distances: Distances,
}

impl Scales {
    /// Of a bake on `lattice` whose mip 0 has `mip0_size` texels along its longer side.
    pub(crate) fn new(config: &BakeConfig, lattice: &Lattice, mip0_size: u32) -> Self {
        // Cells serve footprints up to a texel of mip 0; the ramp reaches half of one outwards.
        let ramp = 0.5 * lattice.longer_steps() / f64::from(mip0_size.max(1));
        let outline = f64::from(config.outline_texels.unwrap_or(0.0));
        let needed = 2.0 * (outline + ramp + ROUNDING_MARGIN);
        let range = f64::from(to_f32(needed.max(f64::from(config.distance_range_texels))));
        let smoothing = f64::from(config.smoothing) * range;
        Self {
            range,
            distances: Distances {
                margin: outline + ramp.max(smoothing) + ROUNDING_MARGIN,
                reach: 0.5 * range + REACH_BEYOND_RANGE,
            },
        }
    }
}
