//! Spec keys: what they hold for a content, and keys of an earlier ABI.

use vtex_format::{AddressMode, Entry, EntryKind, Features, Limits, SpecKey, VtexFile};

use crate::forge::{put_together, take_apart};
use crate::grouped::grouped;
use crate::sample;

/// Where `SPEC` stands in the samples.
const SPEC: usize = 1;

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

/// The bytes of a file whose key has these words.
fn with_words(file: &VtexFile, words: [u32; 8]) -> Vec<u8> {
    let mut sections = take_apart(&file.to_bytes().unwrap());
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    sections[SPEC].refill(&bytes);
    put_together(&sections)
}

#[test]
fn keys_of_abi_1_are_read_as_keys_of_today() {
    let mut file = grouped();
    file.meta.sampler.address = [AddressMode::Mirror, AddressMode::Border];
    let file = sample::with_key(file);
    // ABI 1 knew neither, and repeated address modes, texels along a cell, and bounds of lists.
    let old = file.spec.features & !(Features::MAPPING | Features::DEEP_GROUPS);
    let bytes = with_words(&file, [1, old, 2, 3, 2, 11, 3, 0]);
    let read = VtexFile::parse(&bytes, &Limits::default()).unwrap();
    // For all that the words say, the groups may be deep.
    let features = file.spec.features | Features::DEEP_GROUPS;
    assert_eq!(read.spec, SpecKey { features });
    assert_eq!(SpecKey::for_file(&read), file.spec, "a loader looks itself");
    let again = VtexFile::parse(&read.to_bytes().unwrap(), &Limits::default());
    assert_eq!(again.unwrap(), read, "written as a file of today");
}
