//! Words of base cells and blocks. A file has them as evaluators read them, but lists by number, counted
//! back from the first that no cell before has named: mostly that one itself, which is 0.

use crate::layout::{cell, cmd, has_list, is_block};
use crate::subdivide::{Grid, LARGEST, SMALLEST, Side, base_size, block_words};

/// What cells must fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) side: Side,
    /// Columns and rows of the file's cells.
    pub(super) cells: [u32; 2],
    /// Whether blocks have levels coarser than their cells.
    pub(super) has_levels: bool,
    pub(super) paints: usize,
}

/// Words as a file has them.
pub(super) fn stored<'a>(
    words: &'a [u32],
    commands: &[[u32; 4]],
) -> impl Iterator<Item = u32> + use<'a> {
    let mut numbers = vec![0; commands.len()];
    let (mut count, mut begins) = (0, true);
    for (number, command) in numbers.iter_mut().zip(commands) {
        if begins {
            *number = count;
            count += 1;
        }
        begins = command[3] & cmd::LAST_BIT != 0;
    }
    let mut next = 0_u32;
    words.iter().map(move |&word| {
        if !has_list(word) {
            return word;
        }
        let place = (word & cell::PAYLOAD_MASK) as usize;
        let number: u32 = numbers.get(place).copied().unwrap_or(0);
        let back = next.wrapping_sub(number) & cell::PAYLOAD_MASK;
        next = next.max(number.saturating_add(1));
        word & !cell::PAYLOAD_MASK | back
    })
}

/// The grid of stored words, where `lists` has the words of cells with lists; `None` where a word names
/// what does not exist.
pub(super) fn grid(stored: &[u32], lists: &[u32], shape: &Shape) -> Option<Grid> {
    if !(SMALLEST..=LARGEST).contains(&shape.side) {
        return None;
    }
    let size = base_size(shape.cells.map(|count| count as usize), shape.side);
    let base = size[0].checked_mul(size[1])?;
    if base > stored.len() {
        return None;
    }
    let mut next = 0_u32;
    let mut leaf = |word: u32| match word >> cell::TAG_SHIFT {
        cell::EMPTY => (!is_block(word)).then_some(word),
        cell::SOLID => ((word & cell::PAINT_MASK) as usize)
            .lt(&shape.paints)
            .then_some(word),
        tag => {
            let number = next.wrapping_sub(word) & cell::PAYLOAD_MASK;
            let word = *lists.get(number as usize)?;
            next = next.max(number + 1);
            (word >> cell::TAG_SHIFT == tag).then_some(word)
        }
    };
    let mut words = Vec::with_capacity(stored.len());
    let mut end = base;
    for &word in &stored[..base] {
        words.push(match is_block(word) {
            true => block(word, base, &mut end, shape).then_some(word)?,
            false => leaf(word)?,
        });
    }
    if end != stored.len() {
        return None;
    }
    for &word in &stored[base..] {
        words.push(leaf(word)?);
    }
    Some(Grid {
        side: shape.side,
        size,
        words,
        has_levels: shape.has_levels,
    })
}

/// Whether a base cell names a block behind `first`: one before `end`, where those that are known end, or
/// the next one.
fn block(word: u32, first: usize, end: &mut usize, shape: &Shape) -> bool {
    let depth = word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK;
    let place = (word & cell::PLACE_MASK) as usize;
    let behind = place + block_words(shape.side, depth, shape.has_levels);
    if place == *end {
        *end = behind;
    }
    depth > 0 && word & cell::NARROW_BIT == 0 && place >= first && behind <= *end
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: u32 = cell::LIST << cell::TAG_SHIFT;
    const SOLID: u32 = cell::SOLID << cell::TAG_SHIFT;

    const SHAPE: Shape = Shape {
        side: 0,
        cells: [3, 1],
        has_levels: false,
        paints: 2,
    };

    fn block_at(place: u32, depth: u32) -> u32 {
        cell::BLOCK << cell::BLOCK_SHIFT | depth << cell::DEPTH_SHIFT | place
    }

    fn made(words: &[u32]) -> Option<Vec<u32>> {
        Some(grid(words, &[LIST, LIST | 5], &SHAPE)?.words)
    }

    #[test]
    fn stored_words_come_back() {
        let commands = [0, 0, 0, 0, cmd::LAST_BIT, cmd::LAST_BIT].map(|tag| [0, 0, 0, tag]);
        let base = [block_at(3, 1), SOLID | 1, block_at(3, 1)];
        let words = [&base[..], &[LIST, LIST | 5, 0, LIST]].concat();
        let stored: Vec<u32> = stored(&words, &commands).collect();
        assert_eq!(stored[3..], [LIST, LIST, 0, LIST | 2]);
        assert_eq!(made(&stored).as_ref(), Some(&words));
    }

    #[test]
    fn words_that_name_nothing_are_refused() {
        let sound = [block_at(3, 1), SOLID, 0, LIST, LIST, 0, 0];
        assert!(made(&sound).is_some());
        let with = |at: usize, word| {
            let mut words = sound;
            words[at] = word;
            made(&words)
        };
        for (what, at, word) in [
            ("a paint too many", 1, SOLID | 2),
            ("a paint too many in a block", 6, SOLID | 2),
            ("a list too many", 6, LIST | 0x3fff_ffff),
            ("a third list", 6, LIST),
            ("a list with groups", 6, LIST | SOLID | 2),
            ("a block in a block", 6, block_at(3, 1)),
            ("a block among base cells", 0, block_at(0, 1)),
            ("a block behind the end", 2, block_at(7, 1)),
            ("a block across the end", 0, block_at(3, 2)),
            ("a block without cells", 0, block_at(3, 0)),
            ("a narrow block", 0, cell::NARROW_BIT | block_at(3, 1)),
            ("no block where words are", 0, 0),
        ] {
            assert_eq!(with(at, word), None, "{what}");
        }
        assert_eq!(made(&sound[..2]), None, "too few words");
        assert_eq!(made(&[&sound[..], &[0; 4]].concat()), None, "too many");
        let beside = |side| grid(&sound, &[LIST, LIST], &Shape { side, ..SHAPE });
        assert_eq!(
            [SMALLEST - 1, -1, LARGEST + 1].map(beside),
            [None, None, None]
        );
    }

    #[test]
    fn blocks_have_their_levels() {
        let shape = Shape {
            has_levels: true,
            ..SHAPE
        };
        // A block of 4 x 4 cells, and one cell for all of it.
        let words = |length| [vec![block_at(3, 2), 0, 0], vec![0; length]].concat();
        assert!(grid(&words(17), &[], &shape).is_some());
        assert!(grid(&words(16), &[], &shape).is_none());
        assert!(grid(&words(16), &[], &SHAPE).is_some());
    }
}
