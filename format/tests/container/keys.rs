//! Spec keys: what they hold for a content.

use vtex_format::{Entry, EntryKind, Features, VtexFile};

use crate::sample;

/// The sample with a list of `depth` groups in one another instead of its own.
fn nested(depth: usize) -> VtexFile {
    let entry = |kind| Entry {
        kind,
        last: false,
        opaque: false,
        index: 0,
        data: 0,
    };
    let last = Entry {
        last: true,
        ..entry(EntryKind::Full)
    };
    let open = vec![entry(EntryKind::Open); depth];
    let close = vec![entry(EntryKind::Close); depth];
    let list = [open, close, vec![last]].concat();
    let mut file = sample::small();
    file.entries = list.iter().flat_map(|e| e.encode().unwrap()).collect();
    file.cells.fill(2 << 30);
    file.meta.sampler.outline = None;
    file
}

#[test]
fn deep_groups_are_those_of_more_than_two_levels() {
    for (depth, deep) in [(0, false), (1, false), (2, false), (3, true), (32, true)] {
        let mut file = sample::with_key(nested(depth));
        let found = file.spec.features & Features::DEEP_GROUPS != 0;
        assert_eq!(found, deep, "{depth} groups");
        file.spec.features &= !Features::DEEP_GROUPS;
        let codes: Vec<u16> = file.check().iter().map(|issue| issue.code).collect();
        assert_eq!(codes.contains(&3033), deep, "{depth} groups: {codes:?}");
    }
}
