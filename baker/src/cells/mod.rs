//! The cells of the grid: for each a list of what shows in it, front to back.
//!
//! Items are packed into ranks first ([`packing`]), then each cell drafts its list ([`draft`]). The
//! tiles and curve records that lists name come last.

mod draft;
mod input;
pub(crate) mod layers;
mod lists;
pub(crate) mod packing;
pub(crate) mod paint_table;
pub(crate) mod stored_outlines;
#[cfg(test)]
mod tests;
pub(crate) mod tiles;

pub(crate) use draft::build_cells;
pub(crate) use input::CellInput;
pub(crate) use lists::CellLists;
