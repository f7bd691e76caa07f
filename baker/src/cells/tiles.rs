//! The texels of MSDF tiles.

use rayon::prelude::*;

use super::{input::CellInput, lists::TileDraft};
use crate::{
    coverage::{classify::tile_spec, grid::Lattice, msdf::render_tile, scales::Scales},
    error::BakeError,
};

/// Bytes of MSDF tiles in a file. Beyond it most GPUs refuse the buffer, and a smaller lattice
/// would serve better.
const MAX_TILE_BYTES: usize = 1 << 30;

/// The texels of `tiles`, one tile after the other.
///
/// # Errors
/// [`BakeError::Limit`] when they are more than a file may hold.
pub(crate) fn render_tiles(
    input: &CellInput<'_>,
    tiles: &[TileDraft],
    lattice: &Lattice,
    scales: &Scales,
) -> Result<Vec<u8>, BakeError> {
    let side = lattice.grid.texels_per_cell as usize + 1;
    let tile_bytes = 4 * side * side;
    let total = tiles.len().saturating_mul(tile_bytes);
    if total > MAX_TILE_BYTES {
        return Err(BakeError::Limit(format!(
            "{} MiB of MSDF tiles; bake with a smaller MSDF size",
            total >> 20
        )));
    }
    let mut texels = vec![0; total];
    texels
        .par_chunks_exact_mut(tile_bytes)
        .zip(tiles)
        .for_each(|(texels, tile)| {
            let shape = |&item: &u32| {
                let region = &input.placed[item as usize].region;
                let cells = &input.covers[item as usize].cells;
                cells.tile_shape(tile.cell, region)
            };
            let shapes = tile.items.iter().map(shape).collect();
            let spec = tile_spec(tile.cell, lattice, scales, shapes);
            texels.copy_from_slice(&render_tile(&spec));
        });
    Ok(texels)
}
