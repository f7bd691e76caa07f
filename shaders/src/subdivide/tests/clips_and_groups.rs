//! What is left of clips and groups in parts of a cell.

use vtex_format::{CurveHeader, Entry, EntryKind};

use super::super::outline::Region;
use super::Sample;
use crate::layout::cmd;

/// The record of all that lies left of x = 2000, and one of all that lies above y = 2000.
fn records() -> Vec<u32> {
    let header = |base_winding, line_count| CurveHeader {
        line_count,
        step_count: 1 - line_count,
        base_winding,
        ..CurveHeader::default()
    };
    let mut words = header(1, 1).encode().expect("fits").to_vec();
    words.extend([2000, 2000 | 0xffff << 16]);
    words.extend(header(1, 0).encode().expect("fits"));
    words.push(2000 | 0xffff << 16);
    words
}

const LEFT: u32 = 0;
const ABOVE: u32 = 4;

fn list(entries: &[(EntryKind, bool, u32, u32)]) -> Sample {
    let count = entries.len();
    let words = entries
        .iter()
        .enumerate()
        .flat_map(|(at, &(kind, opaque, index, data))| {
            let entry = Entry {
                kind,
                last: at + 1 == count,
                opaque,
                index,
                data,
            };
            entry.encode().expect("sound")
        });
    Sample::decode(&words.collect::<Vec<_>>(), &records())
}

fn count(list: &Sample) -> usize {
    list.commands().len()
}

/// The part of the cell around a place.
fn around(x: f64, y: f64) -> Region {
    Region {
        x: [x - 100.0, x + 100.0],
        y: [y - 100.0, y + 100.0],
    }
}

/// Tags of the commands without what a list's order gives them.
fn tags(list: &Sample) -> Vec<u32> {
    let commands = list.commands();
    let kept = cmd::CONTROL_BIT | cmd::INDEX_MASK | cmd::OPAQUE_BIT;
    commands.iter().map(|command| command[3] & kept).collect()
}

const FULL: EntryKind = EntryKind::Full;
const BRANCH: EntryKind = EntryKind::Branch;

#[test]
fn branches_that_are_decided_go() {
    let clip = list(&[
        (BRANCH, false, 1, LEFT),
        (FULL, true, 3, 0),
        (FULL, true, 4, 0),
    ]);
    assert_eq!(clip.within(&around(1000.0, 900.0)).solid(), Some(3));
    assert_eq!(clip.within(&around(3000.0, 900.0)).solid(), Some(4));
    let edge = clip.within(&around(2000.0, 900.0));
    let branch = cmd::CONTROL_BIT | 1;
    let opaque = cmd::OPAQUE_BIT;
    assert_eq!(tags(&edge), [branch, opaque | 3, opaque | 4]);
    assert!(!edge.has_groups());
}

#[test]
fn a_union_becomes_the_part_that_counts() {
    let union = list(&[
        (BRANCH, true, 1, LEFT),
        (BRANCH, false, 1, ABOVE),
        (FULL, false, 3, 0),
    ]);
    assert_eq!(union.within(&around(1000.0, 3000.0)).solid(), Some(3));
    assert_eq!(union.within(&around(3000.0, 1000.0)).solid(), Some(3));
    assert!(union.within(&around(3000.0, 3000.0)).is_empty());
    // Only the left one is left: it is turned, so that its body follows it.
    let edge = union.within(&around(2000.0, 3000.0));
    assert_eq!(tags(&edge), [cmd::CONTROL_BIT, 3]);
    let both = union.within(&around(2000.0, 2000.0));
    assert_eq!(count(&both), count(&union));
}

#[test]
fn groups_of_nothing_go() {
    let half = 0.5_f32.to_bits();
    let group = |opacity: u32| {
        list(&[
            (EntryKind::Open, false, 0, 1),
            (EntryKind::Curves, false, 1, LEFT),
            (EntryKind::Mask, false, 3, 0),
            (EntryKind::Open, false, 0, 0),
            (EntryKind::Curves, false, 1, ABOVE),
            (EntryKind::Close, false, 0, opacity),
        ])
    };
    let visible = group(half).within(&around(1000.0, 1000.0));
    assert_eq!(count(&visible), 6);
    assert!(visible.has_groups());
    assert!(group(half).within(&around(3000.0, 1000.0)).is_empty());
    assert!(group(half).within(&around(1000.0, 3000.0)).is_empty());
    assert!(group(0).within(&around(1000.0, 1000.0)).is_empty());
    let plain = |opacity: f32| {
        list(&[
            (EntryKind::Open, false, 0, 0),
            (FULL, false, 1, 0),
            (EntryKind::Close, false, 0, opacity.to_bits()),
        ])
    };
    assert_eq!(plain(1.0).within(&around(1000.0, 0.0)).solid(), Some(1));
    assert_eq!(plain(0.5).within(&around(1000.0, 0.0)).solid(), None);
}
