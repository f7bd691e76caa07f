//! Base cells and blocks: the words that evaluators read for the trees of the file's cells.

mod narrow;

use std::collections::{BTreeMap, BTreeSet};

use vtex_format::MAX_GRID_SIDE;

use super::hash;
use super::tree::{Tree, is_level};
use crate::layout::{cell, has_list};

/// A side of base cells: `2^side` cells of the file lie along one.
pub(crate) type Side = i32;

/// Base cells up to this much smaller than the file's are tried.
pub(crate) const SMALLEST: Side = -2;
/// No base cell is larger: one is as large as any grid.
pub(crate) const LARGEST: Side = MAX_GRID_SIDE.ilog2().cast_signed() + 1;
/// Deepest block.
const MAX_BLOCK_DEPTH: u32 = cell::DEPTH_MASK;

/// The picture as trees.
#[derive(Clone, Debug, Default)]
pub(super) struct Picture {
    /// Columns and rows of the file's cells.
    pub(super) size: [usize; 2],
    /// Each cell's tree, row by row.
    pub(super) cells: Vec<u32>,
    /// No two are leaves with the same word.
    pub(super) trees: Vec<Tree>,
    /// Whether blocks have levels coarser than their cells.
    pub(super) has_levels: bool,
    /// Whether cells of blocks are to be narrow, where they can be.
    pub(super) narrows: bool,
}

/// Base cells, and blocks behind them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Grid {
    /// `2^side` cells of the file lie along a base cell.
    pub(crate) side: Side,
    /// Columns and rows of base cells.
    pub(crate) size: [usize; 2],
    pub(crate) words: Vec<u32>,
    /// Whether blocks have levels coarser than their cells.
    pub(crate) has_levels: bool,
}

/// The depths of the levels of a block, from fine to coarse, without that of its cells. Levels are no
/// coarser than the block and than a cell of the file, as lists are for one.
pub(super) fn levels(side: Side, depth: u32) -> impl Iterator<Item = u32> {
    let coarsest = side.max(0).unsigned_abs();
    (coarsest..depth)
        .rev()
        .filter(move |depth| is_level(depth.wrapping_sub(side.cast_unsigned())))
}

/// Columns and rows of base cells where so many of the file's cells lie along the sides of the grid.
pub(crate) fn base_size(cells: [usize; 2], side: Side) -> [usize; 2] {
    cells.map(|count| match side.try_into() {
        Ok(side) => count.div_ceil(1_usize << u32::min(side, 31)),
        Err(_) => count << side.unsigned_abs(),
    })
}

/// Words that a block takes.
pub(crate) fn block_words(side: Side, depth: u32, has_levels: bool) -> usize {
    let levels = levels(side, depth).filter(|_| has_levels);
    let words = |depth: u32| 1_usize << (2 * depth);
    words(depth) + levels.map(words).sum::<usize>()
}

impl Grid {
    /// Base cells along one of the file's, a power of two.
    pub(crate) fn base_per_cell(&self) -> f32 {
        2.0_f32.powi(-self.side)
    }
}

/// What a base cell shows: trees of the file's cells, row by row, or a part of one.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Content {
    trees: Vec<usize>,
    /// Column and row of the part.
    part: [usize; 2],
}

impl Picture {
    /// The grid with the fewest words; `None` if there is none that words can name.
    pub(super) fn grid(&self) -> Option<Grid> {
        if self.size.contains(&0) {
            return Some(Grid::default());
        }
        let depths: Vec<u32> = self.trees.iter().map(Tree::depth).collect();
        let mut best: Option<(usize, Side)> = None;
        for side in SMALLEST..=0 {
            if let Some(words) = self.count_parts(side)
                && best.is_none_or(|(least, _)| words <= least)
            {
                best = Some((words, side));
            }
        }
        // Joined cells are deeper blocks: once that takes more words, so does joining more.
        let largest = self.size[0].max(self.size[1]).ilog2() + 1;
        for side in 1..=largest.cast_signed() {
            match self.count_joined(side, &depths) {
                Some(words) if best.is_none_or(|(least, _)| words < least) => {
                    best = Some((words, side));
                }
                _ => break,
            }
        }
        self.build(best?.1, &depths)
    }

    /// The grid of base cells of this side.
    #[cfg(test)]
    pub(super) fn grid_of(&self, side: Side) -> Option<Grid> {
        let depths: Vec<u32> = self.trees.iter().map(Tree::depth).collect();
        self.build(side, &depths)
    }

    fn base_size(&self, side: Side) -> [usize; 2] {
        base_size(self.size, side)
    }

    fn content(&self, side: Side, [x, y]: [usize; 2]) -> Content {
        let cell = |x: usize, y: usize| {
            // What lies beyond the grid is never read.
            let [x, y] = [x.min(self.size[0] - 1), y.min(self.size[1] - 1)];
            self.cells[y * self.size[0] + x] as usize
        };
        if side < 0 {
            let shift = side.unsigned_abs();
            return Content {
                trees: vec![cell(x >> shift, y >> shift)],
                part: [x, y].map(|at| at & ((1 << shift) - 1)),
            };
        }
        let [columns, rows] = [x, y].map(|at| at << side..(at + 1) << side);
        Content {
            trees: rows
                .flat_map(|y| columns.clone().map(move |x| cell(x, y)))
                .collect(),
            part: [0; 2],
        }
    }

    /// The word of a base cell that no block divides, and else the block's depth.
    fn word_or_depth(&self, side: Side, content: &Content, depths: &[u32]) -> Result<u32, u32> {
        let trees = &content.trees;
        if side <= 0 {
            let part = self.trees[trees[0]].part(side.unsigned_abs(), content.part);
            return part.word().ok_or_else(|| part.depth());
        }
        let same = trees.iter().all(|tree| *tree == trees[0]);
        match self.trees[trees[0]].word() {
            // A list is for one cell of the file.
            Some(word) if same && !has_list(word) => Ok(word),
            _ => {
                let deepest = trees.iter().map(|&tree| depths[tree]).max().unwrap_or(0);
                Err(side.unsigned_abs() + deepest)
            }
        }
    }

    /// Words of a block's cells.
    fn words_at(&self, depth: u32) -> usize {
        let cells = 1 << (2 * depth);
        if self.narrows { 1 + cells / 2 } else { cells }
    }

    /// Words that a side takes where base cells are parts of the file's.
    fn count_parts(&self, side: Side) -> Option<usize> {
        let shift = side.unsigned_abs();
        let [columns, rows] = self.base_size(side);
        let mut words = columns * rows;
        for tree in &self.trees {
            for at in places([1 << shift; 2]) {
                let depth = tree.part(shift, at).depth();
                if depth > MAX_BLOCK_DEPTH {
                    return None;
                }
                words += if depth > 0 { self.words_at(depth) } else { 0 };
            }
        }
        Some(words)
    }

    /// Words that a side takes where the file's cells are parts of base cells.
    fn count_joined(&self, side: Side, depths: &[u32]) -> Option<usize> {
        let size = self.base_size(side);
        let mut words = size[0] * size[1];
        let mut seen = BTreeSet::new();
        for at in places(size) {
            let content = self.content(side, at);
            if let Err(depth) = self.word_or_depth(side, &content, depths) {
                if depth > MAX_BLOCK_DEPTH {
                    return None;
                }
                if seen.insert(content) {
                    words += self.words_at(depth);
                }
            }
        }
        Some(words)
    }

    fn build(&self, side: Side, depths: &[u32]) -> Option<Grid> {
        let size = self.base_size(side);
        let mut blocks = Blocks::new(size[0] * size[1]);
        if side <= 0 {
            self.build_parts(side, &mut blocks)?;
        } else {
            self.build_joined(side, depths, &mut blocks)?;
        }
        Some(Grid {
            side,
            size,
            words: blocks.words,
            has_levels: self.has_levels,
        })
    }

    /// Base cells that are parts of the file's: each tree's are made once.
    fn build_parts(&self, side: Side, blocks: &mut Blocks) -> Option<()> {
        let shift = side.unsigned_abs();
        let mut known = vec![None; self.trees.len() << (2 * shift)];
        for (index, [x, y]) in places(self.base_size(side)).enumerate() {
            let tree = self.cells[(y >> shift) * self.size[0] + (x >> shift)] as usize;
            let part = [x, y].map(|at| at & ((1 << shift) - 1));
            let known = &mut known[(tree << shift | part[1]) << shift | part[0]];
            blocks.words[index] = match *known {
                Some(word) => word,
                None => *known.insert(self.part_word(side, tree, part, blocks)?),
            };
        }
        Some(())
    }

    /// The word of a base cell that is a part of a tree.
    fn part_word(
        &self,
        side: Side,
        tree: usize,
        part: [usize; 2],
        blocks: &mut Blocks,
    ) -> Option<u32> {
        let shown = self.trees[tree].part(side.unsigned_abs(), part);
        if let Some(word) = shown.word() {
            return Some(word);
        }
        let content = Content {
            trees: vec![tree],
            part,
        };
        self.add_block(side, &content, shown.depth(), blocks)
    }

    fn add_block(
        &self,
        side: Side,
        content: &Content,
        depth: u32,
        blocks: &mut Blocks,
    ) -> Option<u32> {
        let mut words = self.block(side, content, depth);
        for level in levels(side, depth).filter(|_| self.has_levels) {
            words.extend(self.block(side, content, level));
        }
        blocks.add(depth, &words)
    }

    /// Base cells of which the file's are parts.
    fn build_joined(&self, side: Side, depths: &[u32], blocks: &mut Blocks) -> Option<()> {
        let size = self.base_size(side);
        let mut known = BTreeMap::new();
        for (index, at) in places(size).enumerate() {
            let content = self.content(side, at);
            blocks.words[index] = match self.word_or_depth(side, &content, depths) {
                Ok(word) => word,
                Err(depth) => match known.get(&content) {
                    Some(&word) => word,
                    None => {
                        let word = self.add_block(side, &content, depth, blocks)?;
                        known.insert(content, word);
                        word
                    }
                },
            };
        }
        Some(())
    }

    /// A level of a block: its `2^depth` rows of as many words.
    fn block(&self, side: Side, content: &Content, depth: u32) -> Vec<u32> {
        let pitch = 1 << depth;
        let mut words = vec![0; pitch * pitch];
        let shift = side.unsigned_abs();
        if side <= 0 {
            let part = self.trees[content.trees[0]].part(shift, content.part);
            part.fill(&mut words, pitch, [0; 2], depth);
            return words;
        }
        for (index, &tree) in content.trees.iter().enumerate() {
            let at = [index & ((1 << shift) - 1), index >> shift];
            let deep = depth - shift;
            self.trees[tree].fill(&mut words, pitch, at.map(|at| at << deep), deep);
        }
        words
    }
}

/// Column and row, row by row.
pub(super) fn places([columns, rows]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    (0..rows).flat_map(move |y| (0..columns).map(move |x| [x, y]))
}

/// Base cells, and blocks behind them, no two alike.
struct Blocks {
    words: Vec<u32>,
    /// Words of base cells by the hash of their block. Of two with one hash the first is shared.
    known: BTreeMap<u64, u32>,
}

impl Blocks {
    fn new(base: usize) -> Self {
        Self {
            words: vec![0; base],
            known: BTreeMap::new(),
        }
    }

    /// The word of a base cell with this block.
    fn add(&mut self, depth: u32, block: &[u32]) -> Option<u32> {
        let pairs = block.chunks(2).map(|pair| {
            let word = |at: usize| u64::from(pair.get(at).copied().unwrap_or(0));
            word(1) << 32 | word(0)
        });
        let hash = pairs.fold(u64::from(depth), hash::mix);
        if let Some(&word) = self.known.get(&hash) {
            let first = (word & cell::PLACE_MASK) as usize;
            let same_depth = word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK == depth;
            if same_depth && self.words[first..].starts_with(block) {
                return Some(word);
            }
        }
        let place = u32::try_from(self.words.len()).ok()?;
        if place > cell::PLACE_MASK {
            return None;
        }
        let word = cell::BLOCK << cell::BLOCK_SHIFT | depth << cell::DEPTH_SHIFT | place;
        self.words.extend(block);
        self.known.entry(hash).or_insert(word);
        Some(word)
    }
}
