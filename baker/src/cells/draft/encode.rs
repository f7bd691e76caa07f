//! From drafts to the words that the file stores.

use std::collections::BTreeMap;

use vtex_format::{
    CellWord, Entry, EntryKind, MAX_BLEND_DEPTH, MAX_ENTRIES_PER_CELL, MaskKind, list_blend_depth,
};

use super::{
    block::{Block, Compositing, GroupDraft},
    clip::Branch,
    entry::{CurvesDraft, Draft},
};
use crate::{
    cells::{
        lists::{CellLists, TileDraft},
        paint_table::PaintTable,
    },
    error::BakeError,
};

/// Appends drafts to the file's sections. Equal lists and equal records are stored once.
pub(super) struct ListEncoder<'a> {
    lists: CellLists,
    /// Offset of each list so far.
    shared: BTreeMap<Vec<u32>, u32>,
    /// Offset of each curve record so far.
    records: BTreeMap<Vec<u32>, u32>,
    paints: &'a PaintTable,
}

/// An entry that names no paint; its kind and data are filled in.
const CONTROL: Entry = Entry {
    kind: EntryKind::Open,
    last: false,
    opaque: false,
    index: 0,
    data: 0,
};

impl<'p> ListEncoder<'p> {
    /// An encoder without cells. `tiles` are sorted: their order is that of the file.
    pub(super) fn new(tiles: Vec<TileDraft>, paints: &'p PaintTable) -> Self {
        Self {
            lists: CellLists {
                tiles,
                ..CellLists::default()
            },
            shared: BTreeMap::new(),
            records: BTreeMap::new(),
            paints,
        }
    }

    /// All cells.
    pub(super) fn into_lists(self) -> CellLists {
        self.lists
    }

    /// Appends the next cell.
    pub(super) fn push_cell(&mut self, blocks: &[Block<'_>]) -> Result<(), BakeError> {
        let word = match blocks {
            [] => CellWord::Empty,
            [Block::Entry(Draft::Full { paint })] => CellWord::Paint { paint: *paint },
            blocks => CellWord::List {
                offset_words: self.list_offset(blocks)?,
            },
        };
        let word = word.encode();
        self.lists.words.push(word.ok_or_else(|| {
            BakeError::Limit("more paints or entries than a cell can name".into())
        })?);
        Ok(())
    }

    /// Offset of the list in the section, which may be that of an equal one.
    fn list_offset(&mut self, blocks: &[Block<'_>]) -> Result<u32, BakeError> {
        let count: usize = blocks.iter().map(Block::entry_count).sum();
        // Counted before entries are made, so that a hostile drawing cannot take the memory.
        if count > MAX_ENTRIES_PER_CELL as usize {
            return Err(BakeError::Limit(format!(
                "{count} shapes show in one cell of the grid, at most {MAX_ENTRIES_PER_CELL} can"
            )));
        }
        let mut entries = Vec::with_capacity(count);
        self.blocks(blocks, &mut entries)?;
        if let Some(last) = entries.last_mut() {
            last.last = true;
        }
        // Invariant of the format: evaluators have a stack of fixed size.
        if list_blend_depth(&entries).map_or(true, |depth| depth > MAX_BLEND_DEPTH) {
            return Err(BakeError::Limit("groups nest too deeply".into()));
        }
        let mut words = Vec::with_capacity(2 * entries.len());
        for entry in entries {
            words.extend(entry.encode().ok_or_else(|| {
                BakeError::Limit("more paints or images than an entry can name".into())
            })?);
        }
        let next = u32::try_from(self.lists.entries.len())
            .map_err(|_| BakeError::Limit("the cells' lists are too long".into()))?;
        // A new list goes to the end; a known one keeps its place and nothing is appended.
        let offset = *self.shared.entry(words.clone()).or_insert(next);
        if offset == next {
            self.lists.entries.extend(words);
        }
        Ok(offset)
    }

    fn blocks(&mut self, blocks: &[Block<'_>], entries: &mut Vec<Entry>) -> Result<(), BakeError> {
        for block in blocks {
            match block {
                Block::Entry(draft) => entries.push(self.entry(draft)?),
                Block::Group(group) => self.group(group, entries)?,
            }
        }
        Ok(())
    }

    /// Branches, then masks, then the body. Offsets of branches count the entries that they skip:
    /// to the next branch they continue with, or to the group's end.
    fn group(&mut self, group: &GroupDraft<'_>, entries: &mut Vec<Entry>) -> Result<(), BakeError> {
        // Absolute places first; offsets are counted from the entry after the branch.
        let end = entries.len() + Block::group_entry_count(group);
        let first = entries.len();
        for (place, branch) in group.branches.iter().enumerate() {
            let to = branch.to.map_or(end, |branch| first + branch);
            let entry = self.branch(branch, to - (first + place + 1))?;
            entries.push(entry);
        }
        for (kind, blocks) in &group.masks {
            entries.push(open(true));
            self.blocks(blocks, entries)?;
            entries.push(mask(*kind, end - entries.len() - 1)?);
        }
        if let Some(compositing) = &group.compositing {
            entries.push(open(compositing.isolated));
            self.blocks(&group.body, entries)?;
            entries.push(close(compositing));
        } else {
            self.blocks(&group.body, entries)?;
        }
        Ok(())
    }

    fn branch(&mut self, branch: &Branch<'_>, skipped: usize) -> Result<Entry, BakeError> {
        Ok(Entry {
            kind: EntryKind::Branch,
            // In a branch this bit says on which side it is taken.
            opaque: branch.taken_inside,
            index: count(skipped)?,
            data: self.record_offset(&branch.outline)?,
            ..CONTROL
        })
    }

    fn entry(&mut self, draft: &Draft<'_>) -> Result<Entry, BakeError> {
        let (kind, index, data) = match draft {
            Draft::Full { paint } => (EntryKind::Full, *paint, 0),
            Draft::Curves(curves) => {
                let record = self.record_offset(curves)?;
                (EntryKind::Curves, curves.paint, record)
            }
            Draft::Image { image } => (EntryKind::Image, *image, 0),
            Draft::Tile { paint, tile } => {
                // Tiles are sorted, so the index of an equal one is where it would be inserted.
                let tile = self.lists.tiles.partition_point(|other| other < tile);
                let tile = u32::try_from(tile).unwrap_or(u32::MAX);
                (EntryKind::Msdf, *paint, tile)
            }
        };
        Ok(Entry {
            kind,
            last: false,
            // The alpha of an image differs from texel to texel.
            opaque: kind != EntryKind::Image && self.paints.is_opaque(index),
            index,
            data,
        })
    }

    fn record_offset(&mut self, draft: &CurvesDraft<'_>) -> Result<u32, BakeError> {
        let words = &draft.words;
        if let Some(&offset) = self.records.get(words) {
            return Ok(offset);
        }
        let curves = &mut self.lists.curves;
        let offset = u32::try_from(curves.len())
            .map_err(|_| BakeError::Limit("the cells' curves are too many".into()))?;
        curves.extend(words);
        self.records.insert(words.clone(), offset);
        self.lists.record_parts.push(draft.record_parts.clone());
        Ok(offset)
    }
}

fn open(isolated: bool) -> Entry {
    Entry {
        data: u32::from(isolated),
        ..CONTROL
    }
}

fn close(compositing: &Compositing) -> Entry {
    Entry {
        kind: EntryKind::Close,
        index: compositing.blend as u32,
        data: compositing.opacity.to_bits(),
        ..CONTROL
    }
}

fn mask(kind: MaskKind, skipped: usize) -> Result<Entry, BakeError> {
    Ok(Entry {
        kind: EntryKind::Mask,
        index: count(skipped)?,
        data: kind as u32,
        ..CONTROL
    })
}

fn count(entries: usize) -> Result<u32, BakeError> {
    u32::try_from(entries).map_err(|_| BakeError::Limit("a cell's list is too long".into()))
}
