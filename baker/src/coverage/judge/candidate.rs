//! A lattice on which shapes are tried as distance fields.

use crate::{
    config::BakeConfig,
    coverage::{grid::Lattice, scales::Scales},
    drawing::Drawing,
};

/// Steps of a stored distance over its range.
pub(super) const QUANTA: f64 = 255.0;
/// Displacement by rounding alone in quanta, 99th percentile: 0.5 at most. Measured: 0.498 and more
/// on squares at 60 angles; a little less for outlines that lie on the lattice by luck. A lattice on
/// which even this is beyond the bound is not tried.
pub(super) const ROUNDING_QUANTA: f64 = 0.4;

/// A lattice of distance fields and what it means for them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Texels along the canvas' longer side.
    pub(super) size: u32,
    /// The lattice.
    pub(super) lattice: Lattice,
    /// Its distances.
    pub(super) scales: Scales,
    /// Pixels at the largest zoom a lattice step.
    pub(super) px_per_step: f64,
    /// How far an edge may be off.
    pub(super) error_px: f64,
}

impl Candidate {
    /// The lattice with `size` texels along the canvas' longer side.
    pub(super) fn new(drawing: &Drawing, config: &BakeConfig, size: u32) -> Self {
        let lattice = Lattice::new(drawing.canvas_size, size);
        let scales = Scales::new(config, &lattice);
        Self {
            size,
            lattice,
            scales,
            px_per_step: scales.px_per_step(&lattice),
            error_px: config.error_px,
        }
    }

    /// Whether eight bits may be fine enough.
    pub(super) fn resolves(&self) -> bool {
        ROUNDING_QUANTA * self.scales.range / QUANTA * self.px_per_step <= self.error_px
    }
}
