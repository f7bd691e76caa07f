//! The cell grid: for each cell what shows in it, front to back.

mod draft;
mod input;
pub(crate) mod layers;
mod lists;
pub(crate) mod packing;
pub(crate) mod paint_table;
pub(crate) mod sources;
#[cfg(test)]
mod tests;
pub(crate) mod tiles;

pub(crate) use draft::build_cells;
pub(crate) use input::CellInput;
pub(crate) use lists::CellLists;
