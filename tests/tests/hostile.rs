//! Files that are small and ask for much: what reading makes of each.

use vtex_format::{Limits, validate};
use vtex_testing::slow_only;
use vtex_tests::hostile::{HOSTILE, Hostile};

/// Bytes of the largest.
const SMALL_BYTES: usize = 64 << 10;

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

/// Reading looks at every list, record and texel of them; loading is another matter.
#[test]
fn only_too_deep_lists_break_a_rule() {
    for hostile in &HOSTILE {
        let name = hostile.name;
        let wanted: &[u16] = if name == "tests52" { &[5034] } else { &[] };
        let slow = ["entr512", "img14k", "chain8192", "tests52"].contains(&name);
        if !slow || slow_only(&format!("{name}: {}", hostile.what)) {
            assert_eq!(codes(hostile), wanted, "{name}");
        }
    }
}
