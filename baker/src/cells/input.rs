//! What cell lists are made from, and the items of each cell.

use super::packing::Packing;
use crate::{
    coverage::{
        cover::Cover,
        grid::Lattice,
        placed::{Placed, PlacedKind},
    },
    drawing::tree::Tree,
};

/// What lists are made from. The slices hold one element for each item, in painter's order.
#[derive(Debug)]
pub(crate) struct CellInput<'a> {
    /// The items.
    pub(crate) placed: &'a [Placed],
    /// Where they show; empty for images.
    pub(crate) covers: &'a [Cover],
    /// Index of the paint, or of the image.
    pub(crate) paint_or_image: &'a [u32],
    /// Their ranks.
    pub(crate) packing: &'a Packing,
    /// Layer of each rank.
    pub(crate) layer_of_rank: &'a [u32],
    /// The groups that hold the items.
    pub(crate) tree: &'a Tree,
}

/// An item that shows in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Present {
    /// Its index.
    pub(super) item: u32,
    /// Whether it covers the whole cell.
    pub(super) full: bool,
}

/// The items of every cell, in painter's order.
pub(super) fn items_by_cell(input: &CellInput<'_>, lattice: &Lattice) -> Vec<Vec<Present>> {
    let mut by_cell = vec![Vec::new(); lattice.cell_count()];
    for (item, (placed, cover)) in (0_u32..).zip(input.placed.iter().zip(input.covers)) {
        if placed.kind != PlacedKind::Image {
            for &cell in &cover.cells.listed {
                by_cell[cell as usize].push(Present { item, full: false });
            }
            for &cell in &cover.cells.full {
                by_cell[cell as usize].push(Present { item, full: true });
            }
        // An image lists every cell under its box.
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
