//! From outlines to curve records: what `OUTL` stores and how it is cut to cells.

pub mod cut;
pub(crate) mod outlines;
