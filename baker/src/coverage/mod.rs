//! What of each cell an item covers, and by which kind of coverage.

pub(crate) mod classify;
pub(crate) mod cover;
pub(crate) mod curve_lattice;
pub(crate) mod curves;
pub(crate) mod grid;
pub(crate) mod judge;
pub(crate) mod msdf;
pub(crate) mod placed;
pub(crate) mod scales;
pub(crate) mod verdict;
