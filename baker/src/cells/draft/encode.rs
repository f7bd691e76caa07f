//! Lists as the file stores them.

use std::collections::BTreeMap;

use vtex_format::{
    CellWord, Entry, EntryKind, MAX_ENTRIES_PER_CELL, MAX_FRAMES, MaskKind, list_frames,
};

use super::{
    clip::Test,
    entry::{CurvesDraft, Draft},
    unit::{GroupDraft, ScopeDraft, Unit},
};
use crate::{
    cells::{
        lists::{CellLists, TileDraft},
        paint_table::PaintTable,
    },
    error::BakeError,
};

/// Puts drafts into the file's sections, equal ones once.
pub(super) struct ListEncoder<'a> {
    lists: CellLists,
    /// Offsets of the lists so far, so that equal ones are stored once.
    shared: BTreeMap<Vec<u32>, u32>,
    /// Offsets of the records so far.
    records: BTreeMap<Vec<u32>, u32>,
    paints: &'a PaintTable,
}

/// An entry that names no paint.
const CONTROL: Entry = Entry {
    kind: EntryKind::Open,
    last: false,
    opaque: false,
    index: 0,
    data: 0,
};

impl<'p> ListEncoder<'p> {
    /// `tiles` in the order in which they are stored.
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

    pub(super) fn into_lists(self) -> CellLists {
        self.lists
    }

    pub(super) fn push_cell(&mut self, units: &[Unit<'_>]) -> Result<(), BakeError> {
        let word = match units {
            [] => CellWord::Empty,
            [Unit::Entry(Draft::Full { paint })] => CellWord::Solid { paint: *paint },
            units => CellWord::List {
                offset_words: self.list_offset(units)?,
            },
        };
        let word = word.encode();
        self.lists.words.push(word.ok_or_else(|| {
            BakeError::Limit("more paints or entries than a cell can name".into())
        })?);
        Ok(())
    }

    fn list_offset(&mut self, units: &[Unit<'_>]) -> Result<u32, BakeError> {
        let count: usize = units.iter().map(Unit::entry_count).sum();
        if count > MAX_ENTRIES_PER_CELL as usize {
            return Err(BakeError::Limit(format!(
                "{count} shapes show in one cell of the grid, at most {MAX_ENTRIES_PER_CELL} can"
            )));
        }
        let mut entries = Vec::with_capacity(count);
        self.units(units, &mut entries)?;
        if let Some(last) = entries.last_mut() {
            last.last = true;
        }
        if list_frames(&entries).map_or(true, |frames| frames > MAX_FRAMES) {
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
        let offset = *self.shared.entry(words.clone()).or_insert(next);
        if offset == next {
            self.lists.entries.extend(words);
        }
        Ok(offset)
    }

    fn units(&mut self, units: &[Unit<'_>], entries: &mut Vec<Entry>) -> Result<(), BakeError> {
        for unit in units {
            match unit {
                Unit::Entry(draft) => entries.push(self.entry(draft)?),
                Unit::Scope(scope) => self.scope(scope, entries)?,
            }
        }
        Ok(())
    }

    fn scope(&mut self, scope: &ScopeDraft<'_>, entries: &mut Vec<Entry>) -> Result<(), BakeError> {
        let end = entries.len() + Unit::scope_entry_count(scope);
        let first = entries.len();
        for (place, test) in scope.tests.iter().enumerate() {
            let to = test.to.map_or(end, |test| first + test);
            let entry = self.test(test, to - (first + place + 1))?;
            entries.push(entry);
        }
        for (kind, units) in &scope.masks {
            entries.push(open(true));
            self.units(units, entries)?;
            entries.push(mask(*kind, end - entries.len() - 1)?);
        }
        if let Some(group) = &scope.group {
            entries.push(open(group.isolated));
            self.units(&scope.body, entries)?;
            entries.push(close(group));
        } else {
            self.units(&scope.body, entries)?;
        }
        Ok(())
    }

    fn test(&mut self, test: &Test<'_>, skipped: usize) -> Result<Entry, BakeError> {
        Ok(Entry {
            kind: EntryKind::Test,
            opaque: test.jumps_inside,
            index: count(skipped)?,
            data: self.record_offset(&test.outline)?,
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
                let tile = self.lists.tiles.partition_point(|other| other < tile);
                let tile = u32::try_from(tile).unwrap_or(u32::MAX);
                (EntryKind::Msdf, *paint, tile)
            }
        };
        Ok(Entry {
            kind,
            last: false,
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
        self.lists.sources.push(draft.source.clone());
        Ok(offset)
    }
}

fn open(isolated: bool) -> Entry {
    Entry {
        data: u32::from(isolated),
        ..CONTROL
    }
}

fn close(group: &GroupDraft) -> Entry {
    Entry {
        kind: EntryKind::Close,
        index: group.blend as u32,
        data: group.opacity.to_bits(),
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
