//! Files that are small and ask for much: what reading and loading make of each.

use vtex_format::{Limits, VtexFile, validate};
use vtex_shaders::{FilterMode, PackOptions, pack};
use vtex_tests::hostile::{HOSTILE, Hostile};

/// Bytes of the largest.
const SMALL_BYTES: usize = 64 << 10;
/// Words of one that is not refused, 16 MiB.
const MAX_WORDS: usize = 4 << 20;

fn codes(hostile: &Hostile) -> Vec<u16> {
    let bytes = hostile.bytes();
    assert!(
        bytes.len() < SMALL_BYTES,
        "{}: {}",
        hostile.name,
        bytes.len()
    );
    let mut codes: Vec<u16> = validate(&bytes, &Limits::default())
        .iter()
        .map(|issue| issue.code)
        .collect();
    codes.dedup();
    codes
}

/// Those that ask for too much are refused with the limit that they pass.
#[test]
fn what_asks_for_too_much_is_refused() {
    for hostile in &HOSTILE {
        let name = hostile.name;
        let wanted: &[u16] = match name {
            "tests52" => &[5034],
            "chain8192" => &[2020],
            "entr512" | "img14k" => &[2016],
            _ => &[],
        };
        assert_eq!(codes(hostile), wanted, "{name}");
    }
}

/// One list serves all cells that name it, and no list is divided without end.
#[test]
fn what_is_read_loads_into_few_words() {
    let mut loaded = 0;
    for hostile in &HOSTILE {
        let Ok(file) = VtexFile::parse(&hostile.bytes(), &Limits::default()) else {
            continue;
        };
        loaded += 1;
        for filter in [FilterMode::Point, FilterMode::Footprint] {
            let options = PackOptions {
                filter,
                ..PackOptions::default()
            };
            let packed = pack(&file, &options);
            let words = packed.bytes() / 4;
            assert!(words <= MAX_WORDS, "{}, {filter:?}: {words}", hostile.name);
        }
    }
    assert_eq!(loaded, 2);
}
