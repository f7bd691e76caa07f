//! A file whose lists clip, mask and group, what can be wrong with them, and what not.

use vtex_format::{
    BlendMode, CellWord, Entry, EntryKind, Features, MaskKind, OPEN_ISOLATED, VtexFile,
};

use crate::cases::ValueCase;
use crate::sample;

/// As [`sample::small`], but its first cell lists a clipped, masked, blended group with a group of
/// half opacity in it, and its second a part of that list.
pub(crate) fn grouped() -> VtexFile {
    let mut file = sample::small();
    let half = 0.5_f32.to_bits();
    let entries = [
        entry(EntryKind::Branch, 9, 0),
        entry(EntryKind::Open, 0, OPEN_ISOLATED),
        entry(EntryKind::Full, 1, 0),
        entry(EntryKind::Mask, 6, MaskKind::Luminance as u32),
        entry(EntryKind::Open, 0, OPEN_ISOLATED),
        entry(EntryKind::Open, 0, 0),
        entry(EntryKind::Curves, 1, 3),
        entry(EntryKind::Close, 0, half),
        entry(EntryKind::Full, 1, 0),
        entry(EntryKind::Close, BlendMode::Hue as u32, half),
        Entry {
            last: true,
            ..entry(EntryKind::Full, 0, 0)
        },
    ];
    let place = |at: usize| CellWord::List {
        offset_words: 2 * (FIRST + at) as u32,
    };
    file.cells[0] = place(0).encode().unwrap();
    file.cells[1] = place(10).encode().unwrap();
    let words = entries.iter().flat_map(|entry| entry.encode().unwrap());
    file.entries.extend(words);
    sample::with_key(file)
}

/// Entries of [`sample::small`], in front of those of [`grouped`].
const FIRST: usize = 5;

const fn entry(kind: EntryKind, index: u32, data: u32) -> Entry {
    Entry {
        kind,
        last: false,
        opaque: false,
        index,
        data,
    }
}

/// The first word of an entry of the first cell's list.
fn head(file: &mut VtexFile, at: usize) -> &mut u32 {
    &mut file.entries[2 * (FIRST + at)]
}

fn data(file: &mut VtexFile, at: usize) -> &mut u32 {
    &mut file.entries[2 * (FIRST + at) + 1]
}

/// Makes an entry one that draws.
fn plain(file: &mut VtexFile, at: usize) {
    *head(file, at) = 1;
    *data(file, at) = 0;
}

/// Lets the second cell's list begin elsewhere in the first one's.
fn second(file: &mut VtexFile, at: usize) {
    file.cells[1] = 2 << 30 | (2 * (FIRST + at)) as u32;
}

pub(crate) const GROUPED_VALUES: &[ValueCase] = &[
    (3033, |f| f.spec.features &= !Features::CLIPS),
    (3033, |f| f.spec.features &= !Features::GROUPS),
    (3033, |f| f.spec.features &= !Features::BLENDS),
    (5011, |f| *head(f, 1) |= 1),
    (5011, |f| *data(f, 1) = 2),
    (5011, |f| *data(f, 3) = 3),
    (5011, |f| *head(f, 9) |= 1 << 4),
    (5011, |f| *data(f, 7) = 1.5_f32.to_bits()),
    (5011, |f| *data(f, 7) = f32::NAN.to_bits()),
    (5011, |f| *head(f, 7) |= 1 << 26),
    (5016, |f| *data(f, 0) = 8),
    (5020, |f| f.curves[1] = 3),
    // Over the end, into the group, onto its end.
    (5030, |f| *head(f, 0) += 2),
    (5030, |f| *head(f, 0) -= 1),
    (5030, |f| *head(f, 0) -= 8),
    // A branch at a group's end, and at the list's.
    (5030, |f| *head(f, 8) = 4 << 28 | 1),
    (5030, |f| *head(f, 10) = 4 << 28 | 1 << 27 | 1),
    (5031, |f| plain(f, 4)),
    (5031, |f| plain(f, 9)),
    (5031, |f| *head(f, 8) |= 1 << 27),
    // Lists that begin in the middle of another one.
    (5031, |f| second(f, 2)),
    (5031, |f| second(f, 6)),
    (5032, |f| *head(f, 3) += 1),
    (5032, |f| *head(f, 3) -= 1),
    (5032, |f| *data(f, 1) = 0),
    (5032, |f| {
        *head(f, 7) = 7 << 28 | 1;
        *data(f, 7) = 0;
    }),
    (5033, |f| *data(f, 4) = 0),
    (5034, deep),
];

/// A list of thirty-three groups in one another.
fn deep(file: &mut VtexFile) {
    file.entries.truncate(2 * FIRST);
    let open = entry(EntryKind::Open, 0, 0);
    let close = entry(EntryKind::Close, 0, 0);
    let last = Entry {
        last: true,
        ..close
    };
    let list = [vec![open; 33], vec![close; 32], vec![last]].concat();
    let words = list.iter().flat_map(|entry| entry.encode().unwrap());
    file.entries.extend(words);
}

#[test]
fn the_sample_needs_what_it_holds() {
    let file = grouped();
    assert_eq!(file.check(), []);
    let bits = Features::CLIPS | Features::GROUPS | Features::BLENDS;
    assert_eq!(file.spec.features & bits, bits);
    assert_eq!(sample::small().spec.features & bits, 0);
}

#[test]
fn lists_may_begin_where_blocks_do() {
    for at in [1, 4, 10] {
        let mut file = grouped();
        second(&mut file, at);
        assert_eq!(file.check(), [], "entry {at}");
        file.cells[0] = 0;
        assert_eq!(file.check(), [], "entry {at}");
    }
}
