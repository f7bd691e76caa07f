//! Lists of control entries written as letters, and what they parse to.

use super::*;
use ListFaultKind::{Blend, BlendDepth, Bracket, Branch, Mask};

/// A list from words: `e` draws, `b3` branches over three entries, `(` opens a group, `<`
/// an isolated one, `)` closes it, `*` closes with a blend mode, `m4` ends a mask.
fn list(text: &str) -> Vec<Entry> {
    let words = text.split_whitespace().map(|word| {
        let (letter, number) = word.split_at(1);
        let index = number.parse().unwrap_or(0);
        let (kind, index, data) = match letter {
            "e" => (EntryKind::Full, 0, 0),
            "b" => (EntryKind::Branch, index, 0),
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

/// Blocks as text: branches in brackets before what they guard.
fn written(blocks: &[Block]) -> String {
    let block = |block: &Block| match block {
        Block::Draw(at) => at.to_string(),
        Block::Clip { branches, body } => format!("[{branches:?} {}]", written(body)),
        Block::Group { masks, body, .. } => {
            let masks: String = masks
                .iter()
                .map(|mask| format!("<{}>", written(&mask.body)))
                .collect();
            format!("{masks}({})", written(body))
        }
    };
    blocks.iter().map(block).collect::<Vec<_>>().join(" ")
}

fn check(text: &str, expected: &str, depth: u32) {
    let entries = list(text);
    let blocks = list_blocks(&entries).unwrap_or_else(|fault| panic!("{text}: {fault}"));
    assert_eq!(written(&blocks), expected, "{text}");
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
fn clips_are_as_long_as_their_branches() {
    check("e e", "0 1", 0);
    check("b1 e e", "[0..1 1] 2", 1);
    check("b2 e e e", "[0..1 1 2] 3", 1);
    // Two clips of one body, and a clip in front of what another one also guards.
    check("b2 b1 e", "[0..2 2]", 1);
    check("b3 b1 e e", "[0..1 [1..2 2] 3]", 2);
    // A union, one of three, and one whose first part is itself clipped.
    check("b1 b2 e e e", "[0..2 2 3] 4", 2);
    check("b2 b1 b1 e", "[0..3 3]", 2);
    check("b1 b2 b2 b1 e", "[0..4 4]", 2);
    // A union within a clip with the same end, and within one that guards more.
    check("b3 b1 b1 e", "[0..3 3]", 2);
    check("b4 b1 b1 e e", "[0..1 [1..3 3] 4]", 3);
    check("b3 e b1 e", "[0..1 1 [2..3 3]]", 2);
}

#[test]
fn groups_hold_what_is_between_their_ends() {
    check("( e ) e", "(1) 3", 1);
    check("( )", "()", 1);
    check("b3 ( e ) e", "[0..1 (2)] 4", 2);
    check("( b1 e e )", "([1..2 2] 3)", 2);
    check("< e m3 < e * e", "<1>(4) 6", 1);
    check("< m8 < ( e ) m3 ( e )", "<><(4)>(8)", 2);
    check("b6 < e m3 ( e ) e", "[0..1 <2>(5)] 7", 2);
    check("< < e m3 < e ) e m3 ( e )", "<<2>(5) 7>(10)", 2);
}

#[test]
fn branches_lead_where_blocks_end() {
    refuse("b1", 0, Branch);
    refuse("b1 b1", 0, Branch);
    refuse("b2 e", 0, Branch);
    refuse("b2 b5 e", 0, Branch);
    // Into, out of and across groups.
    refuse("b2 ( e )", 0, Branch);
    refuse("b1 ( e )", 0, Branch);
    refuse("( b2 e ) e", 1, Branch);
    refuse("( e b1 ) e", 2, Branch);
    // Among what another branch guards.
    refuse("b2 e b2 e e", 1, Branch);
    refuse("b2 b2 e e", 2, Branch);
    refuse("e b2 e b1 e", 2, Branch);
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
    refuse("b3 < e m3 ( e )", 3, Mask);
}

#[test]
fn levels_of_the_blend_stack_are_counted_to_the_bound() {
    let nested = |depth: usize| format!("{} e {}", "( ".repeat(depth), ") ".repeat(depth));
    assert_eq!(list_blend_depth(&list(&nested(32))), Ok(32));
    let error = list_blend_depth(&list(&nested(33))).map_err(|fault| fault.kind);
    assert_eq!(error, Err(BlendDepth));
    // Clips that each guard one entry more than the next.
    let clips = |depth: usize| -> String {
        let branches: String = (0..depth)
            .map(|i| format!("b{} ", 2 * depth - 1 - 2 * i))
            .collect();
        branches + &"e ".repeat(depth)
    };
    assert_eq!(list_blend_depth(&list(&clips(32))), Ok(32));
    for depth in [33, 60, 70, 2000] {
        let error = list_blend_depth(&list(&clips(depth))).map_err(|fault| fault.kind);
        assert_eq!(error, Err(BlendDepth), "{depth}");
    }
    let same = "b2000 ".split_whitespace().cycle().take(2000);
    let same: Vec<String> = same
        .enumerate()
        .map(|(i, _)| format!("b{}", 2000 - i))
        .collect();
    assert_eq!(list_blend_depth(&list(&(same.join(" ") + " e"))), Ok(1));
}
