//! Cells' lists: drafted cell by cell, then stored with equal parts shared.

mod clip;
mod encode;
mod entry;
mod unit;

use super::{
    input::{self, CellInput},
    lists::CellLists,
    paint_table::PaintTable,
};
use crate::{coverage::grid::Lattice, error::BakeError};
use encode::ListEncoder;
use unit::Unit;

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
