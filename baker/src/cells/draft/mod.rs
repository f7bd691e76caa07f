//! Drafting the cells' lists: what shows in each cell, cut to what a lookup can see.
//!
//! A draft becomes entries only after all cells are drafted, because the index of a tile is known
//! only once all tiles are sorted.

mod block;
mod clip;
mod encode;
mod entry;

use super::{
    input::{self, CellInput},
    lists::CellLists,
    paint_table::PaintTable,
};
use crate::{coverage::grid::Lattice, error::BakeError};
use block::Block;
use encode::ListEncoder;

/// Builds the list of every cell.
///
/// # Errors
/// [`BakeError::Limit`] when a list holds more than the format allows.
pub(crate) fn build_cells(
    input: &CellInput<'_>,
    lattice: &Lattice,
    paints: &mut PaintTable,
) -> Result<CellLists, BakeError> {
    let drafts: Vec<Vec<Block<'_>>> = input::items_by_cell(input, lattice)
        .into_iter()
        .zip(0_u32..)
        .map(|(items, cell)| block::draft_cell(input, &items, cell, paints))
        .collect();
    let mut tiles = Vec::new();
    for block in drafts.iter().flatten() {
        block.tiles(&mut tiles);
    }
    // The format wants tiles by layer. A layer may have several tiles in a cell, one for each
    // paint.
    tiles.sort_unstable();
    let mut encoder = ListEncoder::new(tiles, paints);
    for cell in &drafts {
        encoder.push_cell(cell)?;
    }
    Ok(encoder.into_lists())
}
