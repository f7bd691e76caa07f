//! The cell grid: for each cell what shows in it, front to back.

mod clip;
mod draft;
mod encode;
mod input;
pub(crate) mod layers;
mod lists;
pub(crate) mod packing;
pub(crate) mod paint_table;
pub(crate) mod sources;
#[cfg(test)]
mod tests;
pub(crate) mod tiles;
mod unit;

use crate::{coverage::grid::Lattice, error::BakeError};
use encode::ListEncoder;
use paint_table::PaintTable;
use unit::Unit;

pub(crate) use input::CellInput;
pub(crate) use lists::CellLists;

/// Builds every cell's list.
pub(crate) fn build_cells(
    input: &CellInput<'_>,
    lattice: &Lattice,
    paints: &mut PaintTable,
) -> Result<CellLists, BakeError> {
    let drafts: Vec<Vec<Unit<'_>>> = input::items_by_cell(input, lattice)
        .into_iter()
        .zip(0_u32..)
        .map(|(items, cell)| unit::draft_cell(input, &items, cell, paints))
        .collect();
    let mut tiles = Vec::new();
    for unit in drafts.iter().flatten() {
        unit.tiles(&mut tiles);
    }
    // Layer by layer as the format wants; within a cell a layer may have a tile a paint.
    tiles.sort_unstable();
    let mut encoder = ListEncoder::new(tiles, paints);
    for cell in &drafts {
        encoder.push_cell(cell)?;
    }
    Ok(encoder.into_lists())
}
