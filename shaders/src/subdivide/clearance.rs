//! How far around a fine cell everything shows the same: most footprints need to know no more.

use crate::layout::cell;

/// Of a cell whose neighbours are not known to differ.
const GREATEST: u8 = cell::CLEARANCE_MASK.to_le_bytes()[0];

/// Writes their clearance into the words of cells without lists; `words` has rows of `pitch`.
/// Beyond the grid nothing differs, because no lookup samples there.
pub(super) fn write(words: &mut [u32], pitch: usize) {
    if pitch == 0 {
        return;
    }
    let mut clearances = alone(words, pitch);
    let rows = words.len() / pitch;
    // There and back: a clearance is at most one more than that of any neighbour.
    for y in 0..rows {
        for x in 0..pitch {
            let left = x.checked_sub(1).map(|x| clearances[y * pitch + x]);
            let above = y
                .checked_sub(1)
                .map_or(u8::MAX, |y| three(&clearances[y * pitch..][..pitch], x));
            shrink(&mut clearances[y * pitch + x], left, above);
        }
    }
    for y in (0..rows).rev() {
        for x in (0..pitch).rev() {
            let right = (x + 1 < pitch).then(|| clearances[y * pitch + x + 1]);
            let below = clearances
                .get((y + 1) * pitch..)
                .filter(|rest| !rest.is_empty());
            let below = below.map_or(u8::MAX, |rest| three(&rest[..pitch], x));
            shrink(&mut clearances[y * pitch + x], right, below);
        }
    }
    for (word, &clearance) in words.iter_mut().zip(&clearances) {
        if shows_one_paint(*word) {
            *word |= u32::from(clearance) << cell::CLEARANCE_SHIFT;
        }
    }
}

fn shows_one_paint(word: u32) -> bool {
    word >> cell::TAG_SHIFT < cell::LIST
}

/// The greatest clearance where a cell and its eight neighbours show the same paint, else none.
fn alone(words: &[u32], pitch: usize) -> Vec<u8> {
    let row_is_even = |row: &[u32], x: usize, word: u32| {
        let least = x.saturating_sub(1);
        row[least..row.len().min(x + 2)]
            .iter()
            .all(|&other| other == word)
    };
    let rows: Vec<&[u32]> = words.chunks_exact(pitch).collect();
    let mut clearances = Vec::with_capacity(words.len());
    for (y, row) in rows.iter().enumerate() {
        let near = &rows[y.saturating_sub(1)..rows.len().min(y + 2)];
        clearances.extend(row.iter().enumerate().map(|(x, &word)| {
            let even = shows_one_paint(word) && near.iter().all(|row| row_is_even(row, x, word));
            if even { GREATEST } else { 0 }
        }));
    }
    clearances
}

/// The least clearance of a row's cells above or below `x`.
fn three(row: &[u8], x: usize) -> u8 {
    let cells = &row[x.saturating_sub(1)..row.len().min(x + 2)];
    cells.iter().copied().min().unwrap_or(u8::MAX)
}

fn shrink(clearance: &mut u8, beside: Option<u8>, row: u8) {
    let least = row.min(beside.unwrap_or(u8::MAX));
    *clearance = (*clearance).min(least.saturating_add(1));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By definition, square by square.
    fn clearance_at(words: &[u32], pitch: usize, [x, y]: [usize; 2]) -> u32 {
        let rows = words.len() / pitch;
        let word = words[y * pitch + x];
        let same = |around: usize| {
            let rows = y.saturating_sub(around)..rows.min(y + around + 1);
            rows.flat_map(|y| {
                let columns = x.saturating_sub(around)..pitch.min(x + around + 1);
                columns.map(move |x| y * pitch + x)
            })
            .all(|at| words[at] == word)
        };
        let distances = 1..=cell::CLEARANCE_MASK;
        distances
            .take_while(|&around| same(around as usize))
            .last()
            .unwrap_or(0)
    }

    #[test]
    fn clearances_are_squares_that_show_the_same() {
        let pitch = 37;
        let solid = |paint| cell::SOLID << cell::TAG_SHIFT | paint;
        let list = cell::LIST << cell::TAG_SHIFT | 5;
        let words: Vec<u32> = (0..pitch * 29)
            .map(|at| match (at % pitch, at / pitch) {
                (9, 7) | (30, 20..) => list,
                (x, y) if x > 12 && y > 14 => solid(1),
                (0..4, _) => cell::EMPTY,
                _ => solid(0),
            })
            .collect();
        let mut marked = words.clone();
        write(&mut marked, pitch);
        for (at, &word) in marked.iter().enumerate() {
            let expected = if shows_one_paint(word) {
                words[at]
                    | clearance_at(&words, pitch, [at % pitch, at / pitch]) << cell::CLEARANCE_SHIFT
            } else {
                words[at]
            };
            assert_eq!(word, expected, "cell {at}");
        }
    }

    #[test]
    fn an_even_grid_has_the_greatest_clearance() {
        let mut words = vec![cell::SOLID << cell::TAG_SHIFT | 3; 200 * 200];
        write(&mut words, 200);
        let clearance = cell::CLEARANCE_MASK << cell::CLEARANCE_SHIFT;
        assert!(
            words
                .iter()
                .all(|&word| word == cell::SOLID << cell::TAG_SHIFT | 3 | clearance)
        );
        write(&mut [], 0);
    }
}
