//! The grid's words, lists and what they name, as the file stores them.

use vtex_format::RecordParts;

/// All cells.
#[derive(Debug, Default)]
pub(crate) struct CellLists {
    /// One word for each cell, see [`vtex_format::CellWord`].
    pub(crate) words: Vec<u32>,
    /// The lists, two words for each [`vtex_format::Entry`].
    pub(crate) entries: Vec<u32>,
    /// Tiles, sorted by layer, then by cell.
    pub(crate) tiles: Vec<TileDraft>,
    /// Curve records, one after the other.
    pub(crate) curves: Vec<u32>,
    /// The outlines that each record is cut from. They are named by item here.
    pub(crate) record_parts: Vec<RecordParts>,
}

/// A tile that some list names.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TileDraft {
    /// Index of its layer.
    pub(crate) layer: u32,
    /// Index of its cell.
    pub(crate) cell: u32,
    /// The items that it holds, in painter's order.
    pub(crate) items: Vec<u32>,
}
