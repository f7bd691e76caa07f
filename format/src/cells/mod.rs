//! The cell grid: words of cells, entries of their lists, and how the entries of a list hang
//! together.

pub(crate) mod blocks;
pub(crate) mod cell;
pub(crate) mod control;
pub(crate) mod lists;
