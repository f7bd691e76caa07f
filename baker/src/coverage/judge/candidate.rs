//! A size of the MSDF lattice that is tried.

use crate::{
    config::BakeConfig,
    coverage::{grid::Lattice, scales::Scales},
    drawing::Drawing,
};

/// Quanta of a stored distance over its range: a texel holds a byte.
pub(super) const QUANTA: f64 = 255.0;
/// How far rounding to bytes alone displaces an edge, in quanta, at the 99th percentile. It is 0.5
/// at most. Measured: 0.498 and more on squares at 60 angles; less for outlines that happen to lie
/// on the lattice. A lattice on which even this exceeds the bound is not tried.
pub(super) const ROUNDING_QUANTA: f64 = 0.4;

/// An MSDF lattice with what its error depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Texels along the canvas' longer side.
    pub(super) size: u32,
    /// The lattice.
    pub(super) lattice: Lattice,
    /// Its distances.
    pub(super) scales: Scales,
    /// Pixels along a lattice step at the largest zoom.
    pub(super) px_per_step: f64,
    /// How far an edge may be displaced, in such pixels.
    pub(super) error_px: f64,
}

impl Candidate {
    /// The lattice with `size` texels along the canvas' longer side.
    pub(super) fn new(drawing: &Drawing, config: &BakeConfig, size: u32) -> Self {
        let lattice = Lattice::new(drawing.canvas_size, size);
        let scales = Scales::new(config);
        Self {
            size,
            lattice,
            scales,
            px_per_step: scales.px_per_step(&lattice),
            error_px: config.error_px,
        }
    }

    /// Whether rounding to bytes leaves an error within the bound.
    pub(super) fn resolves(&self) -> bool {
        ROUNDING_QUANTA * self.scales.range / QUANTA * self.px_per_step <= self.error_px
    }
}
