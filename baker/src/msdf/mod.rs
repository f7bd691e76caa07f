//! Multi-channel signed distance fields (Chlumsky 2015) of shapes, tile by tile.

mod edges;
mod tile;

pub(crate) use edges::{EDGE_ERROR_TEXELS, Edge, edges_of};
pub(crate) use tile::{Rows, TileShape, TileSpec, render_tile};
