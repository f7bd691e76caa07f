//! Lists of control entries written as letters, and what they parse to.

use super::*;
use ListFaultKind::{Blend, BlendDepth, Bracket, Jump, Mask};

/// A list from words: `e` draws, `t3` tests and passes over three entries, `(` opens a group, `<`
/// an isolated one, `)` closes it, `*` closes with a blend mode, `m4` ends a mask.
fn list(text: &str) -> Vec<Entry> {
    let words = text.split_whitespace().map(|word| {
        let (letter, number) = word.split_at(1);
        let index = number.parse().unwrap_or(0);
        let (kind, index, data) = match letter {
            "e" => (EntryKind::Full, 0, 0),
            "t" => (EntryKind::Test, index, 0),
            "(" => (EntryKind::Open, 0, 0),
            "<" => (EntryKind::Open, 0, OPEN_ISOLATED),
            ")" => (EntryKind::Close, 0, 0),
            "*" => (EntryKind::Close, 1, 0),
            "m" => (EntryKind::Mask, index, 0),
            _ => panic!("{word}"),
        };
        Entry {
            kind,
            last: false,
            opaque: false,
            index,
            data,
        }
    });
    words.collect()
}

/// Blocks as text: tests in brackets before what they guard.
fn shown(blocks: &[Block]) -> String {
    let block = |block: &Block| match block {
        Block::Draw(at) => at.to_string(),
        Block::Clip { tests, body } => format!("[{tests:?} {}]", shown(body)),
        Block::Group { masks, body, .. } => {
            let masks: String = masks
                .iter()
                .map(|mask| format!("<{}>", shown(&mask.body)))
                .collect();
            format!("{masks}({})", shown(body))
        }
    };
    blocks.iter().map(block).collect::<Vec<_>>().join(" ")
}

fn check(text: &str, expected: &str, depth: u32) {
    let entries = list(text);
    let blocks = list_blocks(&entries).unwrap_or_else(|fault| panic!("{text}: {fault}"));
    assert_eq!(shown(&blocks), expected, "{text}");
    assert_eq!(list_blend_depth(&entries), Ok(depth), "{text}");
}

fn refuse(text: &str, entry: usize, kind: ListFaultKind) {
    assert_eq!(
        list_blend_depth(&list(text)),
        Err(fault(entry, kind)),
        "{text}"
    );
}

#[test]
fn clips_are_as_long_as_their_jumps() {
    check("e e", "0 1", 0);
    check("t1 e e", "[0..1 1] 2", 1);
    check("t2 e e e", "[0..1 1 2] 3", 1);
    // Two clips of one body, and a clip in front of what another one also guards.
    check("t2 t1 e", "[0..2 2]", 1);
    check("t3 t1 e e", "[0..1 [1..2 2] 3]", 2);
    // A union, one of three, and one whose first part is itself clipped.
    check("t1 t2 e e e", "[0..2 2 3] 4", 2);
    check("t2 t1 t1 e", "[0..3 3]", 2);
    check("t1 t2 t2 t1 e", "[0..4 4]", 2);
    // A union within a clip with the same end, and within one that guards more.
    check("t3 t1 t1 e", "[0..3 3]", 2);
    check("t4 t1 t1 e e", "[0..1 [1..3 3] 4]", 3);
    check("t3 e t1 e", "[0..1 1 [2..3 3]]", 2);
}

#[test]
fn groups_hold_what_is_between_their_ends() {
    check("( e ) e", "(1) 3", 1);
    check("( )", "()", 1);
    check("t3 ( e ) e", "[0..1 (2)] 4", 2);
    check("( t1 e e )", "([1..2 2] 3)", 2);
    check("< e m3 < e * e", "<1>(4) 6", 1);
    check("< m8 < ( e ) m3 ( e )", "<><(4)>(8)", 2);
    check("t6 < e m3 ( e ) e", "[0..1 <2>(5)] 7", 2);
    check("< < e m3 < e ) e m3 ( e )", "<<2>(5) 7>(10)", 2);
}

#[test]
fn jumps_end_where_blocks_do() {
    refuse("t1", 0, Jump);
    refuse("t1 t1", 0, Jump);
    refuse("t2 e", 0, Jump);
    refuse("t2 t5 e", 0, Jump);
    // Into, out of and across groups.
    refuse("t2 ( e )", 0, Jump);
    refuse("t1 ( e )", 0, Jump);
    refuse("( t2 e ) e", 1, Jump);
    refuse("( e t1 ) e", 2, Jump);
    // Among what another test guards.
    refuse("t2 e t2 e e", 1, Jump);
    refuse("t2 t2 e e", 2, Jump);
    refuse("e t2 e t1 e", 2, Jump);
}

#[test]
fn groups_and_masks_are_whole() {
    refuse("e )", 1, Bracket);
    refuse("( e", 0, Bracket);
    refuse("( ( e )", 0, Bracket);
    refuse("( e *", 2, Blend);
    refuse("( e m3 ( e )", 2, Mask);
    refuse("< e m1", 2, Mask);
    refuse("< e m1 e", 2, Mask);
    refuse("< e m2 ( e )", 2, Mask);
    refuse("< e m4 ( e ) e", 2, Mask);
    refuse("< e m3 < e m3 ( e )", 2, Mask);
    refuse("( < e m1 ) ( e )", 3, Mask);
    refuse("t3 < e m3 ( e )", 3, Mask);
}

#[test]
fn levels_of_the_blend_stack_are_counted_to_the_bound() {
    let nested = |depth: usize| format!("{} e {}", "( ".repeat(depth), ") ".repeat(depth));
    assert_eq!(list_blend_depth(&list(&nested(32))), Ok(32));
    let error = list_blend_depth(&list(&nested(33))).map_err(|fault| fault.kind);
    assert_eq!(error, Err(BlendDepth));
    // Clips that each guard one entry more than the next.
    let clips = |depth: usize| -> String {
        let tests: String = (0..depth)
            .map(|i| format!("t{} ", 2 * depth - 1 - 2 * i))
            .collect();
        tests + &"e ".repeat(depth)
    };
    assert_eq!(list_blend_depth(&list(&clips(32))), Ok(32));
    for depth in [33, 60, 70, 2000] {
        let error = list_blend_depth(&list(&clips(depth))).map_err(|fault| fault.kind);
        assert_eq!(error, Err(BlendDepth), "{depth}");
    }
    let same = "t2000 ".split_whitespace().cycle().take(2000);
    let same: Vec<String> = same
        .enumerate()
        .map(|(i, _)| format!("t{}", 2000 - i))
        .collect();
    assert_eq!(list_blend_depth(&list(&(same.join(" ") + " e"))), Ok(1));
}
