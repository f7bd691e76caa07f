//! Cells and the lists of entries they name.

use std::cell::OnceCell;

use crate::cells::blocks::{ListFaultKind, list_blend_depth};
use crate::cells::cell::{
    CellWord, Entry, EntryKind, LAST_BIT, MAX_COMMANDS, MAX_ENTRIES_PER_CELL, MAX_LIST_COMMANDS,
};
use crate::cells::lists::{ListLengths, list_entries};
use crate::container::issue::{self, Issues};
use crate::container::tag::Tag;
use crate::file::texture::VtexFile;
use crate::records::curve::{CURVE_HEADER_WORDS, CurveHeader};
use crate::records::image::Image;

/// So many lists whose entries do not fit together are reported. A file may hold thousands that share
/// their entries, and each takes the time of a whole one.
const MAX_FAULTY_LISTS: usize = 16;

/// What entries may name.
pub(super) struct Tables {
    tile_count: u64,
    /// Whether an image is opaque, found when first asked: it reads every texel.
    opaque_images: Vec<OnceCell<bool>>,
}

impl Tables {
    pub(super) fn of(file: &VtexFile) -> Self {
        let tiles = file.layers.iter().map(|layer| u64::from(layer.tile_count));
        Self {
            tile_count: tiles.sum(),
            opaque_images: vec![OnceCell::new(); file.images.len()],
        }
    }

    fn is_opaque_image(&self, images: &[Image], index: usize) -> bool {
        let known = self.opaque_images.get(index).zip(images.get(index));
        known.is_some_and(|(known, image)| *known.get_or_init(|| image.is_opaque()))
    }
}

/// Every entry has a meaning and names what exists, whether or not a cell lists it.
pub(super) fn entries(file: &VtexFile, tables: &Tables, issues: &mut Issues) {
    let (pairs, rest) = file.entries.as_chunks::<2>();
    if !rest.is_empty() {
        let count = file.entries.len();
        let message = format_args!("{count} words");
        issues.add(
            issue::ENTRY_COUNT,
            Tag::ENTR,
            8 * pairs.len() as u64,
            message,
        );
    }
    for (index, &words) in pairs.iter().enumerate() {
        let offset = 8 * index as u64;
        let Some(entry) = Entry::decode(words) else {
            let [head, data] = words;
            let message = format_args!("words {head:#010x} {data:#010x}");
            issues.add(issue::ENTRY_WORD, Tag::ENTR, offset, message);
            continue;
        };
        if entry.kind.has_record() {
            curve_record(&file.curves, entry.data, offset, issues);
        }
        let (kind, count) = match entry.kind {
            EntryKind::Image => (issue::ENTRY_IMAGE, file.images.len()),
            EntryKind::Full | EntryKind::Msdf | EntryKind::Curves => {
                (issue::ENTRY_PAINT, file.paints.len())
            }
            EntryKind::Branch | EntryKind::Open | EntryKind::Close | EntryKind::Mask => continue,
        };
        let place = entry.index as usize;
        if place >= count {
            let message = format_args!("{place} of {count}");
            issues.add(kind, Tag::ENTR, offset, message);
            continue;
        }
        if entry.kind == EntryKind::Msdf && u64::from(entry.data) >= tables.tile_count {
            let message = format_args!("tile {} of {}", entry.data, tables.tile_count);
            issues.add(issue::ENTRY_TILE, Tag::ENTR, offset + 4, message);
        }
        let opaque = match entry.kind {
            EntryKind::Image => tables.is_opaque_image(&file.images, place),
            _ => file.paints[place].is_opaque(),
        };
        if entry.opaque && !opaque {
            let message = format_args!("{:?} {place}", entry.kind);
            issues.add(issue::ENTRY_OPAQUE, Tag::ENTR, offset, message);
        }
    }
}

/// The record at a word offset has a header and lies inside the section, so that an evaluator
/// reads nothing else. Any words make sound segments.
fn curve_record(curves: &[u32], at: u32, entry_offset: u64, issues: &mut Issues) {
    let record = curves.get(at as usize..).unwrap_or(&[]);
    let length = record.len();
    let Some(&header) = record.first_chunk() else {
        let message = format_args!("header at word {at} of {}", curves.len());
        issues.add(issue::ENTRY_CURVES, Tag::ENTR, entry_offset + 4, message);
        return;
    };
    match CurveHeader::decode(header) {
        None => {
            let message = format_args!("words {:#010x} {:#010x}", header[0], header[1]);
            issues.add(issue::CURVE_HEADER, Tag::CURV, 4 * u64::from(at), message);
        }
        Some(header) if header.record_words() as usize > length => {
            let words = header.record_words();
            let message = format_args!("{words} words at word {at} of {}", curves.len());
            issues.add(issue::ENTRY_CURVES, Tag::ENTR, entry_offset + 4, message);
        }
        Some(_) => {}
    }
}

/// Every cell names what exists, every list ends and its control entries fit together.
pub(super) fn cells(file: &VtexFile, issues: &mut Issues) {
    let [columns, rows] = file.meta.grid.size_cells.map(u64::from);
    if file.cells.len() as u64 != columns * rows {
        let message = format_args!("{} words for {columns} x {rows} cells", file.cells.len());
        issues.add(issue::CELL_COUNT, Tag::CELL, 0, message);
    }
    let lengths = ListLengths::of(&file.entries);
    let mut commands = Commands::of(file);
    let has_controls = has_controls(&file.entries);
    let mut faulty = 0;
    for (index, &word) in file.cells.iter().enumerate() {
        let offset = 4 * index as u64;
        let mut note = |kind, message: std::fmt::Arguments<'_>| {
            issues.add(kind, Tag::CELL, offset, message);
        };
        match CellWord::decode(word) {
            None => note(issue::CELL_WORD, format_args!("word {word:#010x}")),
            Some(CellWord::Empty) => {}
            Some(CellWord::Paint { paint }) if (paint as usize) < file.paints.len() => {}
            Some(CellWord::Paint { paint }) => {
                note(
                    issue::CELL_PAINT,
                    format_args!("{paint} of {}", file.paints.len()),
                );
            }
            Some(CellWord::List { offset_words }) => {
                let length = lengths.at(offset_words as usize / 2);
                // An entry is two words: an odd offset names the second of them.
                match length.filter(|_| offset_words % 2 == 0) {
                    None => note(issue::LIST_OFFSET, format_args!("word {offset_words}")),
                    Some(Some(_)) => {
                        let first = offset_words as usize / 2;
                        let (count, is_new) = commands.take(first);
                        if count > u64::from(MAX_LIST_COMMANDS) {
                            note(issue::LIST_COMMANDS, format_args!("{count} commands"));
                        }
                        // Lists that overlap could take quadratic time. The bound on all commands,
                        // one at least for each entry, keeps the work linear: past it none is
                        // parsed.
                        let parses = has_controls && faulty < MAX_FAULTY_LISTS;
                        if parses && is_new && commands.total <= MAX_COMMANDS {
                            faulty += usize::from(!controls(&file.entries, first, issues));
                        }
                    }
                    Some(None) => note(
                        issue::LIST_END,
                        format_args!("no last entry within {MAX_ENTRIES_PER_CELL}"),
                    ),
                }
            }
        }
    }
    if commands.total > MAX_COMMANDS {
        let message = format_args!("{} of at most {MAX_COMMANDS} commands", commands.total);
        issues.add(issue::ALL_COMMANDS, Tag::CELL, 0, message);
    }
}

/// Whether some entry draws nothing.
fn has_controls(entries: &[u32]) -> bool {
    let (pairs, _) = entries.as_chunks();
    let mut entries = pairs.iter().filter_map(|&words| Entry::decode(words));
    entries.any(|entry| !entry.kind.draws())
}

/// Whether the control entries of the list whose first entry is at `first` fit together.
fn controls(entries: &[u32], first: usize, issues: &mut Issues) -> bool {
    // A list with an entry that means nothing has its issue already.
    let Some(list) = list_entries(entries, first) else {
        return false;
    };
    let Err(fault) = list_blend_depth(&list) else {
        return true;
    };
    let kind = match fault.kind {
        ListFaultKind::Branch => issue::LIST_BRANCH,
        ListFaultKind::Bracket => issue::LIST_GROUP,
        ListFaultKind::Mask => issue::LIST_MASK,
        ListFaultKind::Blend => issue::LIST_BLEND,
        ListFaultKind::BlendDepth => issue::LIST_BLEND_DEPTH,
    };
    let message = format_args!("entry {} of the list at {first}", fault.entry);
    issues.add(kind, Tag::ENTR, 8 * (first + fault.entry) as u64, message);
    false
}

/// Commands of lists, by the entry a list starts with.
struct Commands {
    to_the_end: Vec<u32>,
    taken: Vec<bool>,
    /// Commands of the lists taken so far, each list once.
    total: u64,
}

impl Commands {
    fn of(file: &VtexFile) -> Self {
        let (pairs, _) = file.entries.as_chunks::<2>();
        // From the back, so that lists that overlap take one pass.
        let mut behind = 0_u32;
        let backward = pairs.iter().rev().map(|&words| {
            let last = words[0] & LAST_BIT != 0;
            behind = if last { 0 } else { behind };
            let own = u32::try_from(entry_commands(file, words)).unwrap_or(u32::MAX);
            // More than 32 bits hold is far more than a list may have.
            behind = behind.saturating_add(own);
            behind
        });
        let mut to_the_end: Vec<u32> = backward.collect();
        to_the_end.reverse();
        Self {
            taken: vec![false; to_the_end.len()],
            to_the_end,
            total: 0,
        }
    }

    /// Commands of a list, and whether it is asked for the first time.
    fn take(&mut self, first: usize) -> (u64, bool) {
        // Invariant: the caller has found the length of this list, so the entry exists.
        let commands = u64::from(self.to_the_end[first]);
        let is_new = !std::mem::replace(&mut self.taken[first], true);
        if is_new {
            self.total = self.total.saturating_add(commands);
        }
        (commands, is_new)
    }
}

/// Commands that evaluators walk for an entry; one where its record is not sound.
fn entry_commands(file: &VtexFile, words: [u32; 2]) -> u64 {
    let entry = Entry::decode(words).filter(|entry| entry.kind.has_record());
    let record = entry.and_then(|entry| file.curves.get(entry.data as usize..));
    let header = record.and_then(|record| CurveHeader::decode(*record.first_chunk()?));
    let (Some(record), Some(header)) = (record, header) else {
        return 1;
    };
    let steps = record.iter().skip(CURVE_HEADER_WORDS as usize);
    let steps = steps.take(header.step_count as usize);
    // Evaluators take a command for each unit by which a step changes the winding.
    let changes = steps.map(|step| u64::from((step.cast_signed() >> 16).unsigned_abs()));
    let base = header.base_winding;
    // An evaluator's command holds a base winding of four bits, -8 to 7. Each unit beyond takes
    // another command.
    let beyond = base.saturating_sub(7).max(-8 - base).max(0).unsigned_abs();
    let segments = u64::from(header.line_count) + u64::from(header.quad_count);
    (segments + changes.sum::<u64>() + u64::from(beyond)).max(1)
}
