//! Multi-channel signed distance fields (Chlumsky 2015) of shapes, tile by tile.

mod edges;
mod tile;

#[cfg(test)]
pub(crate) use edges::contours_for_fdsm;
pub(crate) use edges::{EDGE_ERROR_TEXELS, Edge, edges_of};
pub(crate) use tile::{Rows, TileShape, TileSpec, render_tile};
