//! How each item covers the cells of a grid, and by which kind of coverage.
//!
//! [`judge`] gives each shape a verdict: MSDF or curves. [`placed`] puts the items on the grid of
//! [`grid`], and [`cover`] finds the cells that each of them meets or fills: for an MSDF by
//! [`classify`], for curves by cutting ([`curves`]). [`msdf`] renders the tiles of MSDFs.

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
