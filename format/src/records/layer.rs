//! Layers: subsets of shapes that never touch. Those of its shapes that are distance fields share
//! one logical MSDF, stored as tiles.

use bytemuck::{Pod, Zeroable};

/// One layer of the packing, back to front, 16 bytes. Its tiles are stored together.
///
/// A tile holds `(texels_per_cell + 1)^2` RGBA8 texels, row by row: R, G and B are the MSDF, A is
/// 255. Texels sit on the corners of a lattice `texels_per_cell` times finer than the cell grid,
/// so that neighbouring tiles repeat their shared edge and a bilinear lookup needs one tile only.
/// A value `v` of a channel means a signed distance of `(v / 255 - 0.5) *
/// distance_range_texels` lattice steps, inside positive.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct LayerRecord {
    /// First tile.
    pub tile_first: u32,
    /// Number of tiles.
    pub tile_count: u32,
    /// Number of shapes.
    pub shape_count: u32,
    /// Zero.
    pub reserved: u32,
}
