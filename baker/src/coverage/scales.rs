//! The distances of a bake: how far the field of an edge extends, and how many pixels a step is.
//!
//! Lookups in paper mode see the edge of an MSDF from some distance: its coverage falls from 1 to 0
//! over a *ramp* around it, and the distance outline lies outside it. A cell must list every shape
//! whose ramp or outline extends into it. Other lookups see an edge where it is.

use crate::{config::BakeConfig, coverage::grid::Lattice, number::to_f32};

/// Steps beyond half the range within which an edge still takes part in a tile. A bilinear lookup
/// mixes four texels, which lie up to a diagonal (1.42 steps) further from the edge than the
/// lookup.
const DISTANCE_BEYOND_RANGE: f64 = 1.5;
/// Steps by which f32 arithmetic may misplace a lookup in an evaluator, with room to spare.
const ROUNDING_MARGIN: f64 = 0.01;

/// Distances in lattice steps at which an edge concerns a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distances {
    /// A cell lists a shape if an edge is within this distance of it.
    pub(crate) margin: f64,
    /// An edge takes part in the tile of a cell if it is within this distance.
    pub(crate) max_distance: f64,
}

/// Distances of this bake, in steps of its lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// Full width of the distances that a texel stores.
    pub(crate) range: f64,
    /// Distances at which an edge concerns a cell.
    pub(crate) distances: Distances,
    /// Pixels along the canvas' longer side at the largest zoom.
    pub(crate) longer_side_px: f64,
}

impl Scales {
    /// The distances of a bake.
    pub(crate) fn new(config: &BakeConfig) -> Self {
        let outline = f64::from(config.outline_texels.unwrap_or(0.0));
        // Half the range must hold the distance outline: beyond it texels are clamped.
        let needed = 2.0 * (outline + ROUNDING_MARGIN);
        let range = f64::from(to_f32(needed.max(f64::from(config.distance_range_texels))));
        let smoothing = f64::from(config.smoothing) * range;
        Self {
            range,
            distances: Distances {
                margin: outline + smoothing + ROUNDING_MARGIN,
                max_distance: 0.5 * range + DISTANCE_BEYOND_RANGE,
            },
            longer_side_px: config.longer_side_px(),
        }
    }

    /// Pixels along a step at the largest zoom. `lattice` is the one that the scales are for.
    pub(crate) fn px_per_step(&self, lattice: &Lattice) -> f64 {
        self.longer_side_px / lattice.longer_steps()
    }
}
