//! Curves: the exact outline of a shape, cut to the cells that it crosses.
//!
//! An outline is lowered once to monotone lines and quadratics on the curve lattice ([`lower`]). A
//! sweep over each row of cells then cuts the segments to the *box* of each cell: the cell widened
//! by a margin ([`sweep`]). What lies to the left of a box changes the winding inside only through
//! the height at which it is passed; it becomes *steps*. Records hold the result ([`record`]). A
//! cell with more segments than a record holds is split into strips ([`split`]).
//!
//! Invariant: watertight. A lookup counts the crossings to its left; if one is lost or counted
//! twice, a streak runs across the cell. Four rules prevent that:
//! - Every contour is a closed chain of lattice points.
//! - A point that two segments share is rounded once, so it is the same point for both.
//! - The cut at the left edge of a box gives one y to the segment inside and to the step outside.
//! - All comparisons of y are half open: a segment owns its upper end and not its lower one.
//!
//! So the crossings add up at every height, and a lookup can be wrong only within rounding of an
//! edge.

pub(crate) mod lower;
pub(crate) mod record;
pub(crate) mod split;
#[cfg(test)]
mod split_tests;
pub(crate) mod stored_outline;
pub(crate) mod sweep;
#[cfg(test)]
mod tests;

/// Why a shape cannot be curves. The caller falls back to an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum CurveError {
    /// A coordinate is not finite or far beyond any canvas.
    #[error("outline out of range")]
    Range,
    /// A cell has more segments or steps, or a larger winding, than records can hold.
    #[error("outline too complex for a cell")]
    Overflow,
}
