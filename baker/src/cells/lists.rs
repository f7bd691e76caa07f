//! The cells' lists as the file stores them.

use vtex_format::SourceRecord;

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
