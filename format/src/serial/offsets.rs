//! Offsets in cells and entries. In memory they are absolute. A file stores each as its difference
//! from the likeliest one: a list follows the list before it, a record the record before it. So
//! nearly all of them are zero.

use crate::cells::cell::{CELL_TAG_SHIFT, CellWord, EntryKind, KIND_SHIFT};
use crate::cells::lists::ListLengths;
use crate::records::curve::CurveHeader;

/// Bits of a cell word that hold an offset.
const OFFSET_MASK: u32 = (1 << CELL_TAG_SHIFT) - 1;

/// Entries as stored.
pub(crate) fn stored_entries(entries: &[u32], curves: &[u32]) -> Vec<u32> {
    let mut stored = entries.to_vec();
    let mut expected = 0;
    for data in record_offsets(&mut stored) {
        let at = *data;
        // Wrapping both ways: any word in memory comes back, also one that names nothing.
        *data = at.wrapping_sub(expected);
        expected = record_end(curves, at);
    }
    stored
}

/// Entries in memory from stored ones.
pub(crate) fn entries_from_stored(entries: &mut [u32], curves: &[u32]) {
    let mut expected = 0;
    for data in record_offsets(entries) {
        *data = data.wrapping_add(expected);
        expected = record_end(curves, *data);
    }
}

/// The second words of entries that name curve records, whether or not they are sound.
fn record_offsets(entries: &mut [u32]) -> impl Iterator<Item = &mut u32> {
    let (pairs, _) = entries.as_chunks_mut::<2>();
    let kinds = [EntryKind::Curves, EntryKind::Branch].map(|kind| kind as u32);
    pairs
        .iter_mut()
        .filter_map(move |[head, data]| kinds.contains(&(*head >> KIND_SHIFT)).then_some(data))
}

/// Where a record ends that begins at a word; there itself when none does.
fn record_end(curves: &[u32], at: u32) -> u32 {
    let header = curves.get(at as usize..).and_then(<[u32]>::first_chunk);
    let header = header.and_then(|&words| CurveHeader::decode(words));
    at.wrapping_add(header.map_or(0, CurveHeader::record_words))
}

/// Cells as stored.
pub(crate) fn stored_cells(cells: &[u32], entries: &[u32]) -> Vec<u32> {
    let lengths = ListLengths::of(entries);
    let mut stored = cells.to_vec();
    let mut expected = 0;
    for word in lists(&mut stored) {
        let at = *word & OFFSET_MASK;
        *word = *word & !OFFSET_MASK | at.wrapping_sub(expected) & OFFSET_MASK;
        expected = list_end(&lengths, at);
    }
    stored
}

/// Cells in memory from stored ones.
pub(crate) fn cells_from_stored(cells: &mut [u32], entries: &[u32]) {
    let lengths = ListLengths::of(entries);
    let mut expected = 0;
    for word in lists(cells) {
        let at = word.wrapping_add(expected) & OFFSET_MASK;
        *word = *word & !OFFSET_MASK | at;
        expected = list_end(&lengths, at);
    }
}

/// The words of cells that are lists.
fn lists(cells: &mut [u32]) -> impl Iterator<Item = &mut u32> {
    let list = CellWord::List { offset_words: 0 }.encode();
    cells
        .iter_mut()
        .filter(move |word| Some(**word & !OFFSET_MASK) == list)
}

/// Where a list ends that begins at a word; there itself when none does.
fn list_end(lengths: &ListLengths, at: u32) -> u32 {
    let length = lengths.at(at as usize / 2).flatten();
    at.wrapping_add(2 * length.unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_words_round_trip_and_what_follows_is_zero() {
        let curves = [1, 0, 5, 5, 0, 0];
        let last = crate::cells::cell::LAST_BIT;
        let kind = (EntryKind::Curves as u32) << 28;
        let branch = (EntryKind::Branch as u32) << 28;
        let entries = [kind, 0, branch | last, 4, kind | last, 0, kind, u32::MAX, 7];
        let stored = stored_entries(&entries, &curves);
        assert_eq!(stored[..4], [kind, 0, branch | last, 0]);
        let mut back = stored;
        entries_from_stored(&mut back, &curves);
        assert_eq!(back, entries);

        let list = 2 << CELL_TAG_SHIFT;
        let cells = [
            list,
            list | 4,
            0,
            1 << CELL_TAG_SHIFT | 5,
            list,
            list | OFFSET_MASK,
            u32::MAX,
        ];
        let stored = stored_cells(&cells, &entries);
        assert_eq!(stored[..2], [list, list]);
        let mut back = stored;
        cells_from_stored(&mut back, &entries);
        assert_eq!(back, cells);
    }
}
