//! Blocks as they lie in memory: half a word a cell, where words say as much in half of their bits.

use std::collections::BTreeMap;

use super::Grid;
use crate::layout::{cell, half, has_list, is_block};

impl Grid {
    /// The words as evaluators read them. Cells of points: those for footprints say how clear they are, and
    /// have no bits to spare.
    pub(crate) fn narrowed(&self) -> Vec<u32> {
        let base = self.size[0] * self.size[1];
        let mut words = self.words[..base].to_vec();
        words.reserve((self.words.len() - base) / 2);
        let mut known = BTreeMap::new();
        for index in 0..base {
            let word = words[index];
            if !is_block(word) {
                continue;
            }
            let depth = word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK;
            let place = word & cell::PLACE_MASK;
            let (narrow, place) = *known.entry((place, depth)).or_insert_with(|| {
                let next = words.len();
                let cells = &self.words[place as usize..][..1 << (2 * depth)];
                let narrow = push_narrow(cells, &mut words);
                if !narrow {
                    words.extend(cells);
                }
                (narrow, next)
            });
            let bit = if narrow { cell::NARROW_BIT } else { 0 };
            // No greater than what the wide words were named by.
            let place = u32::try_from(place).unwrap_or(0) & cell::PLACE_MASK;
            words[index] = word & !cell::PLACE_MASK | bit | place;
        }
        words
    }
}

/// Appends a block of narrow cells, unless one of them needs a whole word.
fn push_narrow(cells: &[u32], words: &mut Vec<u32>) -> bool {
    let lists = cells.iter().copied().filter(|&word| has_list(word));
    let first = lists.map(|word| word & cell::PAYLOAD_MASK).min();
    let first = first.unwrap_or(0);
    let narrow = |&word: &u32| {
        let payload = word & cell::PAYLOAD_MASK;
        let payload = if has_list(word) {
            payload - first
        } else {
            payload
        };
        (payload <= half::PAYLOAD_MASK)
            .then_some(word >> cell::TAG_SHIFT << half::TAG_SHIFT | payload)
    };
    let length = words.len();
    words.push(first);
    for pair in cells.chunks(2) {
        let [Some(low), Some(high)] = [pair.first(), pair.last()].map(|word| word.and_then(narrow))
        else {
            words.truncate(length);
            return false;
        };
        words.push(high << half::BITS | low);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: u32 = cell::LIST << cell::TAG_SHIFT;
    const GROUPS: u32 = cell::GROUPS << cell::TAG_SHIFT;
    const SOLID: u32 = cell::SOLID << cell::TAG_SHIFT;

    /// Narrow words of a row of base cells, each with a block of depth 1, and these blocks.
    fn narrowed(base: &[usize], blocks: &[[u32; 4]]) -> Vec<u32> {
        let word = |block: &usize| {
            let place = u32::try_from(base.len() + 4 * block).unwrap_or(0);
            cell::BLOCK << cell::BLOCK_SHIFT | 1 << cell::DEPTH_SHIFT | place
        };
        let grid = Grid {
            size: [base.len(), 1],
            words: base
                .iter()
                .map(word)
                .chain(blocks.iter().flatten().copied())
                .collect(),
            ..Grid::default()
        };
        grid.narrowed()
    }

    #[test]
    fn what_fits_takes_half_a_word() {
        let far = 70_000;
        let words = narrowed(
            &[0],
            &[[
                0,
                SOLID | 7,
                LIST | far,
                GROUPS | far | half::PAYLOAD_MASK & !far,
            ]],
        );
        let last = (far | half::PAYLOAD_MASK & !far) - far;
        assert_eq!(words[0] & cell::NARROW_BIT, cell::NARROW_BIT);
        assert_eq!(words[0] & cell::PLACE_MASK, 1);
        assert_eq!(
            words[1..],
            [far, 0x4007 << 16, (0xc000 | last) << 16 | 0x8000]
        );
    }

    #[test]
    fn what_does_not_fit_stays_as_it_is() {
        for block in [
            [LIST, 0, 0, LIST | 0x4000],
            [0, 0, 0, SOLID | 0x4000],
            [SOLID | 1 << cell::CLEARANCE_SHIFT, 0, 0, 0],
        ] {
            let words = narrowed(&[0], &[block]);
            assert_eq!(words[0] & cell::NARROW_BIT, 0, "{block:x?}");
            assert_eq!(words[1..], block, "{block:x?}");
        }
    }

    #[test]
    fn blocks_are_stored_once() {
        let words = narrowed(&[1, 0, 1], &[[LIST, 0, 0, LIST | 0x4000], [SOLID | 3; 4]]);
        assert_eq!(words[0], words[2]);
        assert_eq!([0, 1].map(|at| words[at] & cell::PLACE_MASK), [3, 6]);
        assert_eq!(words.len(), 3 + 3 + 4);
    }
}
