//! Multi-channel signed distance fields (Chlumsky 2015), rendered tile by tile.
//!
//! Three channels store distances to different subsets of the edges, coloured so that their median
//! is sharp at corners ([`edges`]). fdsm computes the distances; the signs come from exact inside
//! tests instead ([`tile`]).

mod edges;
mod tile;

#[cfg(test)]
pub(crate) use edges::contours_for_fdsm;
pub(crate) use edges::{EDGE_ERROR_TEXELS, Edge, edges_of};
pub(crate) use tile::{Rows, TileShape, TileSpec, render_tile};
