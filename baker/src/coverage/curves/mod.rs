//! Curve cells: the exact outline of a shape, cut to the cells it passes through.
//!
//! An outline is lowered once to monotone lines and quadratics on the integer lattice of
//! [`CurveLattice`] ([`lower`]). A sweep over each row of cells then cuts the segments to every
//! cell's box ([`sweep`]); what is left of the box acts on the winding only through the height at
//! which it is passed, and becomes *steps*. Records are what evaluators read ([`record`]).
//!
//! Invariant: watertight. Every contour is a closed chain of lattice points, a point that two
//! segments share is rounded once, the cut at a box's left edge gives one y to the segment inside
//! and to the step outside, and all comparisons of y are half open. So on every height the
//! crossings add up, and a lookup can be wrong only within rounding of an edge.

pub(crate) mod lower;
pub(crate) mod record;
pub(crate) mod split;
#[cfg(test)]
mod split_tests;
pub(crate) mod stored_outline;
pub(crate) mod sweep;
#[cfg(test)]
mod tests;

/// Why a shape cannot be curve cells; the caller falls back to another kind of coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum CurveError {
    /// A coordinate is not finite or far beyond any canvas.
    #[error("outline out of range")]
    Range,
    /// A cell holds more segments or steps, or a larger winding, than a record can.
    #[error("outline too complex for a cell")]
    Overflow,
}
