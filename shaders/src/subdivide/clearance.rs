//! How far around a cell everything shows the same: most footprints need to know no more.

use std::collections::BTreeSet;
use std::ops::Range;

use super::grid::{Grid, levels, places};
use crate::layout::{cell, has_list, is_block};

/// Of a cell whose neighbours are not known to differ.
#[expect(clippy::cast_possible_truncation, reason = "eleven bits")]
const GREATEST: u16 = cell::CLEARANCE_MASK as u16;
/// Parts of a side.
#[expect(clippy::cast_possible_truncation, reason = "far less")]
const PARTS: u16 = cell::CLEARANCE_PARTS as u16;
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
    if grid.has_levels {
        // A block may stand in several places.
        let blocks = places(grid.size).filter_map(|at| grid.block_at(at));
        for block in blocks.collect::<BTreeSet<Block>>() {
            on_levels(grid, &block, &mut clearances);
        }
    }
    let base = grid.size[0] * grid.size[1];
    for (index, (word, clearance)) in grid.words.iter_mut().zip(clearances).enumerate() {
        let divided = index < base && is_block(*word);
        if !has_list(*word) && !divided {
            *word |= u32::from(clearance) << cell::CLEARANCE_SHIFT;
        }
    }
}

/// A block's place and depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Block {
    first: usize,
    depth: u32,
}

impl Block {
    /// Of a base cell's word.
    fn of(word: u32) -> Option<Self> {
        is_block(word).then_some(Self {
            first: (word & cell::PLACE_MASK) as usize,
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
fn inside(grid: &Grid, base: [usize; 2], block: &Block, clearances: &mut [u16]) {
    let pitch = block.pitch();
    let border = (pitch >> grid.side.max(0)).checked_shr(2).unwrap_or(0) << (-grid.side).max(0);
    let border = border.clamp(1, pitch);
    let wide = pitch + 2 * border;
    let words = around(grid, base, block.depth, border);
    let mut distances = alone(&words, wide);
    spread(&mut distances, wide, 1);
    let known = |at: usize| (at + border).min(wide - 1 - border - at);
    let known: Vec<u16> = (0..pitch).map(|at| limited(known(at))).collect();
    for (y, &rows) in known.iter().enumerate() {
        let distances = &distances[(y + border) * wide + border..][..pitch];
        let clearances = &mut clearances[block.first + y * pitch..][..pitch];
        for ((stored, distance), &columns) in clearances.iter_mut().zip(distances).zip(&known) {
            *stored = (*stored).min(PARTS * (*distance).min(columns).min(rows));
        }
    }
}

/// The clearances of a block's coarser levels: what is clear around all cells in a square is around it.
fn on_levels(grid: &Grid, block: &Block, clearances: &mut [u16]) {
    let mut first = block.first + block.pitch() * block.pitch();
    for depth in levels(grid.side, block.depth) {
        let finer = block.depth - depth;
        for (index, [x, y]) in places([1 << depth; 2]).enumerate() {
            let rows = (y << finer..(y + 1) << finer).map(|y| {
                let row = block.first + y * block.pitch();
                &clearances[row + (x << finer)..row + ((x + 1) << finer)]
            });
            let least = rows.flatten().copied().min().unwrap_or(0);
            clearances[first + index] = least >> finer;
        }
        first += 1 << (2 * depth);
    }
}

fn limited(distance: usize) -> u16 {
    u16::try_from(distance).unwrap_or(GREATEST).min(GREATEST)
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
        for columns in columns.chunk_by(|one, other| one.0 == other.0) {
            let base = [columns[0].0, base_y];
            match grid.block_at(base) {
                None => words.extend(columns.iter().map(|_| grid.base_word(base))),
                Some(block) if block.depth == depth => {
                    let row = &grid.words[block.first + y * pitch..][..pitch];
                    words.extend(columns.iter().map(|&(_, x)| row[x]));
                }
                _ => words.extend(
                    columns
                        .iter()
                        .map(|&(_, x)| grid.word_in(base, depth, [x, y])),
                ),
            }
        }
    }
    words
}

/// The clearances of base cells.
fn between(grid: &Grid, clearances: &mut [u16]) {
    let [columns, rows] = grid.size;
    let base = &grid.words[..columns * rows];
    let mut distances = alone(base, columns);
    for (index, [x, y]) in places(grid.size).enumerate() {
        let word = base[index];
        if distances[index] == 0 && !has_list(word) && !is_block(word) {
            distances[index] = beside(grid, [x, y], word);
        }
    }
    spread(&mut distances, columns, PARTS);
    clearances[..base.len()].copy_from_slice(&distances);
}

/// How many parts of a side around a base cell show its word, where a neighbour does not as a whole.
fn beside(grid: &Grid, [x, y]: [usize; 2], word: u32) -> u16 {
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
fn strip(grid: &Grid, base: [usize; 2], beside: [Beside; 2], word: u32) -> u16 {
    let Some(block) = grid.block_at(base) else {
        return if grid.base_word(base) == word {
            PARTS
        } else {
            0
        };
    };
    let pitch = block.pitch();
    // The first `count` rows or columns, and the last of these.
    let range = |beside: Beside, count: usize| match beside {
        Beside::Before => pitch - count..pitch,
        Beside::Same => 0..pitch,
        Beside::Behind => 0..count,
    };
    let last = |beside: Beside, count: usize| match beside {
        Beside::Before => pitch - count..pitch - count + 1,
        Beside::Same => 0..0,
        Beside::Behind => count - 1..count,
    };
    let shows = |mut rows: Range<usize>, columns: Range<usize>| {
        rows.all(|y| {
            let row = &grid.words[block.first + y * pitch..][..pitch];
            row[columns.clone()].iter().all(|&other| other == word)
        })
    };
    let [x, y] = beside;
    let count = (1..=pitch).take_while(|&count| {
        shows(last(y, count), range(x, count)) && shows(range(y, count), last(x, count))
    });
    (limited(count.count()) * PARTS) >> block.depth
}

/// Lets distances grow by no more than `step` from a cell to the next. Rows have `pitch` cells.
fn spread(distances: &mut [u16], pitch: usize, step: u16) {
    let mut rows: Vec<&mut [u16]> = distances.chunks_exact_mut(pitch).collect();
    // There and back: a distance is at most a step more than that of any neighbour.
    for y in 0..rows.len() {
        if let [.., above, row] = &mut rows[..=y] {
            lower(row, above, step);
        }
        along(rows[y].iter_mut(), step);
    }
    for y in (0..rows.len()).rev() {
        if let [row, below, ..] = &mut rows[y..] {
            lower(row, below, step);
        }
        along(rows[y].iter_mut().rev(), step);
    }
}

/// Lets no distance be more than a step beyond that of a cell before it.
fn along<'a>(distances: impl Iterator<Item = &'a mut u16>, step: u16) {
    let mut before = GREATEST;
    for distance in distances {
        *distance = (*distance).min(before + step);
        before = *distance;
    }
}

/// Lets no distance be more than a step beyond those of the next row.
fn lower(row: &mut [u16], next: &[u16], step: u16) {
    let mut least = |at: usize, near: Range<usize>| {
        let near = next[near].iter().copied().min().unwrap_or(GREATEST);
        row[at] = row[at].min(near + step);
    };
    let end = next.len();
    least(0, 0..end.min(2));
    least(end - 1, end.saturating_sub(2)..end);
    let Some(row) = row.get_mut(1..end - 1) else {
        return;
    };
    let beside = next.iter().zip(&next[2.min(end)..]);
    for ((distance, &own), (&left, &right)) in row.iter_mut().zip(&next[1..]).zip(beside) {
        *distance = (*distance).min(own.min(left).min(right) + step);
    }
}

/// The greatest distance where a cell and its eight neighbours show the same paint, else none.
/// `words` has rows of `pitch`.
fn alone(words: &[u32], pitch: usize) -> Vec<u16> {
    // Whether a cell shows a paint, as those beside it do.
    let mut even = Vec::with_capacity(words.len());
    for row in words.chunks_exact(pitch) {
        let paint = |word: u32| !has_list(word) && !is_block(word);
        let first = even.len();
        even.extend(row.iter().map(|&word| paint(word)));
        let pairs = row.windows(2).map(|pair| pair[0] == pair[1]);
        for (at, same) in pairs.enumerate() {
            even[first + at] &= same;
            even[first + at + 1] &= same;
        }
    }
    let last = words.len() / pitch - 1;
    let row = |y: usize| y * pitch..(y + 1) * pitch;
    let mut distances = Vec::with_capacity(words.len());
    for y in 0..=last {
        let [above, below] = [row(y.saturating_sub(1)), row(last.min(y + 1))];
        let own = words[row(y)].iter().zip(&even[row(y)]);
        let above = words[above.clone()].iter().zip(&even[above]);
        let below = words[below.clone()].iter().zip(&even[below]);
        let cells = own.zip(above).zip(below);
        distances.extend(cells.map(|((own, above), below)| {
            let even = own.0 == above.0 && own.0 == below.0 && *own.1 && *above.1 && *below.1;
            if even { GREATEST } else { 0 }
        }));
    }
    distances
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
        Tree::Split {
            whole: None,
            quarters: Box::new(quarters),
        }
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
            has_levels: false,
            narrows: false,
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
                    let around = clearance * own / usize::from(PARTS);
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
            has_levels: false,
            narrows: false,
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
            has_levels: false,
            narrows: false,
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
