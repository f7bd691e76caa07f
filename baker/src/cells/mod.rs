//! The cell grid: for each cell what shows in it, front to back.

mod clip;
mod draft;
mod encode;
pub(crate) mod packing;
pub(crate) mod paint_table;
pub(crate) mod sources;
#[cfg(test)]
mod tests;
mod unit;

use vtex_format::SourceRecord;

use crate::{
    cells::{packing::Packing, paint_table::PaintTable},
    coverage::{
        cover::Cover,
        grid::Lattice,
        placed::{Placed, PlacedKind},
    },
    drawing::tree::Tree,
    error::BakeError,
};
use encode::ListEncoder;
use unit::{Present, Unit};

/// What a cell list is made from: one record an item, in painter's order.
#[derive(Debug)]
pub(crate) struct CellInput<'a> {
    /// The items.
    pub(crate) placed: &'a [Placed],
    /// Where they show; empty for patches.
    pub(crate) covers: &'a [Cover],
    /// Their paint, or their image for a patch.
    pub(crate) paint_or_image: &'a [u32],
    /// Their ranks.
    pub(crate) packing: &'a Packing,
    /// Layer of each rank.
    pub(crate) layer_of_rank: &'a [u32],
    /// How items belong together.
    pub(crate) tree: &'a Tree,
}

/// The grid's words and what they need.
#[derive(Debug, Default)]
pub(crate) struct CellLists {
    /// One word a cell: [`CellWord`].
    pub(crate) words: Vec<u32>,
    /// The lists: [`Entry`].
    pub(crate) entries: Vec<u32>,
    /// Tiles, layer by layer and cell by cell.
    pub(crate) tiles: Vec<TileDraft>,
    /// Curve records, one after the other.
    pub(crate) curves: Vec<u32>,
    /// What each of them is cut from; outlines are items here.
    pub(crate) sources: Vec<SourceRecord>,
}

/// A tile that some cell lists.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TileDraft {
    /// Index of its layer.
    pub(crate) layer: u32,
    /// Index of its cell.
    pub(crate) cell: u32,
    /// Items in it, in painter's order.
    pub(crate) items: Vec<u32>,
}

/// Builds every cell's list.
pub(crate) fn build_cells(
    input: &CellInput<'_>,
    lattice: &Lattice,
    paints: &mut PaintTable,
) -> Result<CellLists, BakeError> {
    let drafts: Vec<Vec<Unit<'_>>> = items_by_cell(input, lattice)
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

/// For every cell the items in it, in painter's order, and whether they cover it whole.
fn items_by_cell(input: &CellInput<'_>, lattice: &Lattice) -> Vec<Vec<Present>> {
    let mut by_cell = vec![Vec::new(); lattice.cell_count()];
    for (item, (placed, cover)) in (0_u32..).zip(input.placed.iter().zip(input.covers)) {
        if placed.kind != PlacedKind::Patch {
            for &cell in &cover.cells.listed {
                by_cell[cell as usize].push(Present { item, full: false });
            }
            for &cell in &cover.cells.full {
                by_cell[cell as usize].push(Present { item, full: true });
            }
        } else if let Some([columns, rows]) = lattice.cells_in(placed.bounds()) {
            for row in rows[0]..=rows[1] {
                for column in columns[0]..=columns[1] {
                    let cell = row * lattice.grid.size_cells[0] + column;
                    by_cell[cell as usize].push(Present { item, full: false });
                }
            }
        }
    }
    by_cell
}
