//! How far around a cell everything shows the same: most footprints need to know no more.

use std::ops::Range;

use super::grid::{Grid, places};
use crate::layout::{cell, has_list};

/// Of a cell whose neighbours are not known to differ.
const GREATEST: u32 = cell::CLEARANCE_MASK;
/// Parts of a side.
const PARTS: u32 = cell::CLEARANCE_PARTS;
/// Stands for what shows no single paint: a list's tag, with a place that no list has.
const MIXED: u32 = u32::MAX;

/// Writes their clearance into the words of cells without lists. Beyond the grid nothing differs,
/// because no lookup samples there.
pub(super) fn write(grid: &mut Grid) {
    if grid.words.is_empty() {
        return;
    }
    let mut clearances = vec![GREATEST; grid.words.len()];
    for at in places(grid.size) {
        if let Some(block) = grid.block_at(at) {
            inside(grid, at, &block, &mut clearances);
        }
    }
    between(grid, &mut clearances);
    let base = grid.size[0] * grid.size[1];
    for (index, (word, clearance)) in grid.words.iter_mut().zip(clearances).enumerate() {
        let divided = index < base && Block::of(*word).is_some();
        if !has_list(*word) && !divided {
            *word |= clearance << cell::CLEARANCE_SHIFT;
        }
    }
}

/// A block's place and depth.
#[derive(Clone, Copy, Debug)]
struct Block {
    first: usize,
    depth: u32,
}

impl Block {
    /// Of a base cell's word.
    fn of(word: u32) -> Option<Self> {
        (word >> cell::BLOCK_SHIFT == cell::BLOCK).then_some(Self {
            first: ((word & cell::PLACE_MASK) * cell::BLOCK_WORDS) as usize,
            depth: word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK,
        })
    }

    fn pitch(&self) -> usize {
        1 << self.depth
    }
}

impl Grid {
    fn base_word(&self, [x, y]: [usize; 2]) -> u32 {
        self.words[y * self.size[0] + x]
    }

    fn block_at(&self, at: [usize; 2]) -> Option<Block> {
        Block::of(self.base_word(at))
    }

    /// The one word in the square in column and row `at` of `2^depth` of a base cell.
    fn word_in(&self, base: [usize; 2], depth: u32, at: [usize; 2]) -> u32 {
        let Some(block) = self.block_at(base) else {
            return self.base_word(base);
        };
        let pitch = block.pitch();
        let Some(finer) = block.depth.checked_sub(depth) else {
            let [x, y] = at.map(|at| at >> (depth - block.depth));
            return self.words[block.first + y * pitch + x];
        };
        let [x, y] = at.map(|at| at << finer);
        let word = self.words[block.first + y * pitch + x];
        let rows = (y..y + (1 << finer)).map(|y| &self.words[block.first + y * pitch + x..]);
        let same = |row: &[u32]| row[..1 << finer].iter().all(|&other| other == word);
        let mut rows = rows;
        if rows.all(same) { word } else { MIXED }
    }
}

/// The clearances of a block's cells: what is known of a quarter of a file's cell around it counts. Of
/// a block in several places the least counts.
fn inside(grid: &Grid, base: [usize; 2], block: &Block, clearances: &mut [u32]) {
    let pitch = block.pitch();
    let border = (pitch >> grid.side.max(0)).checked_shr(2).unwrap_or(0) << (-grid.side).max(0);
    let border = border.clamp(1, pitch);
    let wide = pitch + 2 * border;
    let words = around(grid, base, block.depth, border);
    let mut distances = alone(&words, wide);
    spread(&mut distances, wide, 1);
    for [x, y] in places([pitch; 2]) {
        let edge = |at: usize| (at + border).min(wide - 1 - border - at);
        let known = edge(x).min(edge(y));
        let distance = distances[(y + border) * wide + x + border];
        let clearance = PARTS * distance.min(u32::try_from(known).unwrap_or(GREATEST));
        let stored = &mut clearances[block.first + y * pitch + x];
        *stored = (*stored).min(clearance);
    }
}

/// The words of a base cell in squares of `2^depth`, and of so many around it.
fn around(grid: &Grid, base: [usize; 2], depth: u32, border: usize) -> Vec<u32> {
    let pitch = 1_usize << depth;
    let place = |axis: usize, at: usize| {
        // Counted from the base cell before this one; beyond the grid the last one goes on.
        let from = (base[axis] + 1) * pitch + at;
        let last = (grid.size[axis] + 1) * pitch - 1;
        let from = (from - border).clamp(pitch, last) - pitch;
        (from >> depth, from & (pitch - 1))
    };
    let wide = pitch + 2 * border;
    let columns: Vec<(usize, usize)> = (0..wide).map(|x| place(0, x)).collect();
    let mut words = Vec::with_capacity(wide * wide);
    for (base_y, y) in (0..wide).map(|y| place(1, y)) {
        let row = columns.iter();
        words.extend(row.map(|&(base_x, x)| grid.word_in([base_x, base_y], depth, [x, y])));
    }
    words
}

/// The clearances of base cells.
fn between(grid: &Grid, clearances: &mut [u32]) {
    let [columns, rows] = grid.size;
    let base = &grid.words[..columns * rows];
    let mut distances = alone(base, columns);
    for (index, [x, y]) in places(grid.size).enumerate() {
        let word = base[index];
        if distances[index] == 0 && !has_list(word) && Block::of(word).is_none() {
            distances[index] = beside(grid, [x, y], word);
        }
    }
    spread(&mut distances, columns, PARTS);
    clearances[..base.len()].copy_from_slice(&distances);
}

/// How many parts of a side around a base cell show its word, where a neighbour does not as a whole.
fn beside(grid: &Grid, [x, y]: [usize; 2], word: u32) -> u32 {
    let near = |at: usize, count: usize| at.saturating_sub(1)..count.min(at + 2);
    let mut least = PARTS;
    for base_y in near(y, grid.size[1]) {
        for base_x in near(x, grid.size[0]) {
            let strips = [axis_strip(base_x, x), axis_strip(base_y, y)];
            least = least.min(strip(grid, [base_x, base_y], strips, word));
        }
    }
    least
}

/// Where a neighbour lies along an axis.
#[derive(Clone, Copy, Debug)]
enum Beside {
    Before,
    Same,
    Behind,
}

fn axis_strip(neighbour: usize, at: usize) -> Beside {
    match neighbour.cmp(&at) {
        std::cmp::Ordering::Less => Beside::Before,
        std::cmp::Ordering::Equal => Beside::Same,
        std::cmp::Ordering::Greater => Beside::Behind,
    }
}

/// How many parts of a neighbour's side, from the common side or corner, show `word` alone.
fn strip(grid: &Grid, base: [usize; 2], beside: [Beside; 2], word: u32) -> u32 {
    let Some(block) = grid.block_at(base) else {
        return if grid.base_word(base) == word {
            PARTS
        } else {
            0
        };
    };
    let pitch = block.pitch();
    let range = |beside: Beside, count: usize| -> Range<usize> {
        match beside {
            Beside::Before => pitch - count..pitch,
            Beside::Same => 0..pitch,
            Beside::Behind => 0..count,
        }
    };
    let shows = |count: usize| {
        range(beside[1], count).all(|y| {
            let row = &grid.words[block.first + y * pitch..][..pitch];
            row[range(beside[0], count)]
                .iter()
                .all(|&other| other == word)
        })
    };
    let count = (1..=pitch).take_while(|&count| shows(count)).count();
    (u32::try_from(count).unwrap_or(0) * PARTS) >> block.depth
}

/// Lets distances grow by no more than `step` from a cell to the next. Rows have `pitch` cells.
fn spread(distances: &mut [u32], pitch: usize, step: u32) {
    let rows = distances.len() / pitch;
    // There and back: a distance is at most a step more than that of any neighbour.
    for y in 0..rows {
        for x in 0..pitch {
            let left = x.checked_sub(1).map(|x| distances[y * pitch + x]);
            let above = y
                .checked_sub(1)
                .map_or(GREATEST, |y| three(&distances[y * pitch..][..pitch], x));
            shrink(&mut distances[y * pitch + x], left, above, step);
        }
    }
    for y in (0..rows).rev() {
        for x in (0..pitch).rev() {
            let right = (x + 1 < pitch).then(|| distances[y * pitch + x + 1]);
            let below = distances
                .get((y + 1) * pitch..)
                .filter(|rest| !rest.is_empty());
            let below = below.map_or(GREATEST, |rest| three(&rest[..pitch], x));
            shrink(&mut distances[y * pitch + x], right, below, step);
        }
    }
}

/// The greatest distance where a cell and its eight neighbours show the same paint, else none.
/// `words` has rows of `pitch`.
fn alone(words: &[u32], pitch: usize) -> Vec<u32> {
    let row_is_even = |row: &[u32], x: usize, word: u32| {
        let least = x.saturating_sub(1);
        row[least..row.len().min(x + 2)]
            .iter()
            .all(|&other| other == word)
    };
    let rows: Vec<&[u32]> = words.chunks_exact(pitch).collect();
    let mut distances = Vec::with_capacity(words.len());
    for (y, row) in rows.iter().enumerate() {
        let near = &rows[y.saturating_sub(1)..rows.len().min(y + 2)];
        distances.extend(row.iter().enumerate().map(|(x, &word)| {
            let paint = !has_list(word) && Block::of(word).is_none();
            let even = paint && near.iter().all(|row| row_is_even(row, x, word));
            if even { GREATEST } else { 0 }
        }));
    }
    distances
}

/// The least distance of a row's cells above or below `x`.
fn three(row: &[u32], x: usize) -> u32 {
    let cells = &row[x.saturating_sub(1)..row.len().min(x + 2)];
    cells.iter().copied().min().unwrap_or(GREATEST)
}

fn shrink(distance: &mut u32, beside: Option<u32>, row: u32, step: u32) {
    let least = row.min(beside.unwrap_or(GREATEST));
    *distance = (*distance).min(least.saturating_add(step));
}

#[cfg(test)]
mod tests {
    use super::super::grid::Picture;
    use super::super::tree::Tree;
    use super::*;

    /// A base cell is so many squares wide, and one of the deepest blocks eight.
    const WIDE: usize = 32;
    const LIST: u32 = cell::LIST << cell::TAG_SHIFT | 5;

    fn solid(paint: u32) -> Tree {
        Tree::Leaf(cell::SOLID << cell::TAG_SHIFT | paint)
    }

    fn split(quarters: [Tree; 4]) -> Tree {
        Tree::Split(Box::new(quarters))
    }

    fn picture() -> Picture {
        let list = || Tree::Leaf(LIST);
        let corner = || split([solid(0), solid(0), solid(0), list()]);
        let trees = vec![
            Tree::Leaf(cell::EMPTY),
            solid(0),
            solid(1),
            list(),
            corner(),
            split([solid(0), list(), solid(0), list()]),
            split([corner(), solid(0), solid(1), list()]),
        ];
        let size = [19, 14];
        let cells = places(size).map(|[x, y]| match (x, y) {
            (9, 7) => 3,
            (3, 9) => 6,
            (14, 4) => 4,
            (15, 2..=8) => 5,
            (12, y) if y >= 8 => 3,
            (x, y) if x > 14 && y > 9 => 2,
            (x, _) if x < 2 => 0,
            _ => 1,
        });
        Picture {
            size,
            cells: cells.collect(),
            trees,
        }
    }

    /// The words of squares of the picture, `WIDE` along a base cell, in rows of the number.
    fn squares(grid: &Grid) -> (usize, Vec<u32>) {
        let [columns, rows] = grid.size.map(|count| count * WIDE);
        let word = |[x, y]: [usize; 2]| {
            let at = [x % WIDE, y % WIDE];
            grid.word_in([x / WIDE, y / WIDE], WIDE.ilog2(), at)
        };
        (columns, places([columns, rows]).map(word).collect())
    }

    #[test]
    fn clearances_are_squares_that_show_the_same() {
        for side in -2..=1 {
            let picture = picture();
            let Some(plain) = picture.grid_of(side) else {
                panic!("side {side}");
            };
            let mut marked = plain.clone();
            write(&mut marked);
            let (pitch, words) = squares(&plain);
            let size = picture.size.map(|cells| match u32::try_from(side) {
                Ok(side) => (cells * WIDE) >> side,
                Err(_) => (cells * WIDE) << side.unsigned_abs(),
            });
            let mut most = 0;
            for base in places(plain.size) {
                let block = plain.block_at(base);
                let count = block.map_or(1, |block| block.pitch());
                let own = WIDE / count;
                for at in places([count; 2]) {
                    let [x, y] = [0, 1].map(|axis| base[axis] * WIDE + at[axis] * own);
                    if x >= size[0] || y >= size[1] || words[y * pitch + x] == LIST {
                        continue;
                    }
                    let depth = count.ilog2();
                    let word = marked.word_in(base, depth, at);
                    let clearance = (word >> cell::CLEARANCE_SHIFT & cell::CLEARANCE_MASK) as usize;
                    assert_eq!(
                        word & !(cell::CLEARANCE_MASK << cell::CLEARANCE_SHIFT),
                        words[y * pitch + x]
                    );
                    let around = clearance * own / PARTS as usize;
                    let reach = |from: usize, size: usize| {
                        from.saturating_sub(around)..size.min(from + own + around)
                    };
                    let shows = reach(y, size[1]).all(|row| {
                        let row = &words[row * pitch..][..pitch];
                        row[reach(x, size[0])]
                            .iter()
                            .all(|&other| other == words[y * pitch + x])
                    });
                    assert!(shows, "side {side}, {base:?}, {at:?}: {clearance}");
                    most = most.max(around);
                }
            }
            assert!(most >= WIDE, "side {side}: {most}");
        }
    }

    #[test]
    fn a_neighbour_counts_in_part() {
        let trees = vec![
            solid(0),
            split([solid(0), Tree::Leaf(LIST), solid(0), Tree::Leaf(LIST)]),
        ];
        let picture = Picture {
            size: [4, 1],
            cells: vec![0, 0, 0, 1],
            trees,
        };
        let mut grid = picture.grid_of(0).unwrap();
        write(&mut grid);
        let clearances = [0, 1, 2]
            .map(|x| grid.base_word([x, 0]) >> cell::CLEARANCE_SHIFT & cell::CLEARANCE_MASK);
        assert_eq!(clearances, [20, 12, 4]);
    }

    #[test]
    fn an_even_grid_has_the_greatest_clearance() {
        let picture = Picture {
            size: [300, 300],
            cells: vec![0; 300 * 300],
            trees: vec![solid(3)],
        };
        let mut grid = picture.grid_of(0).unwrap();
        write(&mut grid);
        let clearance = cell::CLEARANCE_MASK << cell::CLEARANCE_SHIFT;
        let word = cell::SOLID << cell::TAG_SHIFT | 3 | clearance;
        assert!(grid.words.iter().all(|&other| other == word));
        // One base cell is enough.
        assert_eq!(picture.grid().unwrap().size, [1, 1]);
    }
}
