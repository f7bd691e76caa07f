//! Distances of a bake: what a step, a texel of mip 0 and a pixel are to each other.

use crate::{config::BakeConfig, coverage::grid::Lattice, number::to_f32};

/// Steps beyond half the range within which an edge still takes part in a tile: bilinear lookups
/// near an edge mix texels that lie up to a diagonal further off.
const REACH_BEYOND_RANGE: f64 = 1.5;
/// Steps by which evaluators' f32 arithmetic may misplace a lookup, with room to spare.
const ROUNDING_MARGIN: f64 = 0.01;

/// Distances in lattice steps at which an edge concerns a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distances {
    /// Within it some filter mode sees partial coverage: the cell lists the shape.
    pub(crate) margin: f64,
    /// Within it the edge takes part in the cell's tile.
    pub(crate) reach: f64,
}

/// Distances of this bake, in steps of its lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// Full width of the stored distances.
    pub(crate) range: f64,
    /// At which edges concern cells.
    pub(crate) distances: Distances,
    /// Pixels along the canvas' longer side at the largest zoom.
    pub(crate) longer_side_px: f64,
}

impl Scales {
    /// The distances of a bake on `lattice`.
    pub(crate) fn new(config: &BakeConfig, lattice: &Lattice) -> Self {
        // Cells serve footprints up to a texel of mip 0; the ramp reaches half of one outwards.
        let ramp = 0.5 * lattice.longer_steps() / f64::from(config.mip0_size.max(1));
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
            longer_side_px: config.longer_side_px(),
        }
    }

    /// Pixels along a step at the largest zoom. `lattice` is the one that the scales are for.
    pub(crate) fn px_per_step(&self, lattice: &Lattice) -> f64 {
        self.longer_side_px / lattice.longer_steps()
    }
}
