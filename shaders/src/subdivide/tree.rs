//! A cell of the file, divided as deep as its content is worth.

use super::depth::{self, Model, Sums};
use super::list::{Arena, List};
use super::lists::{Lists, Shown};
use super::outline::{Region, dilated};
use crate::layout::{FilterMode, cell, has_list};

/// What dividing one list may look at, as [`Arena::work`] counts: beyond it no further depth is tried. Of
/// the lists of 276 drawings the one that needs most takes 122,000.
const MAX_LIST_WORK: u64 = 1 << 20;

/// A square of the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Tree {
    /// It has one word.
    Leaf(u32),
    /// Its quarters, row by row.
    Split {
        /// The word of all of it, where evaluators may want that: on levels of blocks.
        whole: Option<u32>,
        quarters: Box<[Self; 4]>,
    },
}

impl Tree {
    /// How often it is halved.
    pub(super) fn depth(&self) -> u32 {
        match self {
            Self::Leaf(_) => 0,
            Self::Split { quarters, .. } => 1 + quarters.iter().map(Self::depth).max().unwrap_or(0),
        }
    }

    /// The part of it in column and row `at` of `2^depth`.
    pub(super) fn part(&self, depth: u32, at: [usize; 2]) -> &Self {
        match self {
            Self::Split { quarters, .. } if depth > 0 => {
                let bit = |axis: usize| at[axis] >> (depth - 1) & 1;
                quarters[2 * bit(1) + bit(0)].part(depth - 1, at)
            }
            _ => self,
        }
    }

    /// The word where nothing else shows.
    pub(super) fn word(&self) -> Option<u32> {
        match self {
            Self::Leaf(word) => Some(*word),
            Self::Split { .. } => None,
        }
    }

    /// Writes it into the square of `2^depth` words at `at`, in rows of `pitch`. What is finer than that
    /// shows as a whole.
    pub(super) fn fill(&self, words: &mut [u32], pitch: usize, [x, y]: [usize; 2], depth: u32) {
        match self {
            Self::Split { quarters, .. } if depth > 0 => {
                let half = 1 << (depth - 1);
                let corners = [[x, y], [x + half, y], [x, y + half], [x + half, y + half]];
                for (quarter, corner) in quarters.iter().zip(corners) {
                    quarter.fill(words, pitch, corner, depth - 1);
                }
            }
            Self::Split { whole, .. } => words[y * pitch + x] = whole.unwrap_or(cell::EMPTY),
            Self::Leaf(word) => {
                for row in y..y + (1 << depth) {
                    words[row * pitch + x..][..1 << depth].fill(*word);
                }
            }
        }
    }
}

/// Whether squares so often halved from a cell of the file are a level of blocks: one level in two, so
/// that each has a sixteenth of the words of the next.
pub(super) const fn is_level(halvings: u32) -> bool {
    halvings.is_multiple_of(2)
}

/// A part of a cell on the way to a tree.
#[derive(Clone, Copy, Debug)]
struct Part {
    list: List,
    shown: Shown,
    region: Region,
    /// Place of the first of four quarters.
    quarters: Option<usize>,
}

/// Divides one cell of the file after another.
#[derive(Debug)]
pub(super) struct Divider<'a> {
    /// What all of them look like.
    whole: Region,
    filter: FilterMode,
    /// Whether blocks have levels coarser than their cells.
    has_levels: bool,
    model: &'a Model,
    /// How many segments may still be looked at.
    work_left: u64,
    /// What the present cell's parts show.
    arena: Arena,
    parts: Vec<Part>,
    /// How many parts there are down to each depth, from 0 on.
    ends: Vec<usize>,
    stored: Stored,
}

/// Lists of a cell that are stored.
#[derive(Clone, Debug, Default)]
struct Stored {
    /// Hashes of those that no deeper search changes, ascending.
    kept: Vec<u64>,
    /// Those of the present depth.
    present: Vec<(u64, usize)>,
}

impl<'a> Divider<'a> {
    /// `whole` is a cell of the file.
    pub(super) fn new(
        whole: Region,
        filter: FilterMode,
        has_levels: bool,
        model: &'a Model,
        work_left: u64,
    ) -> Self {
        Self {
            whole,
            filter,
            has_levels,
            model,
            work_left,
            arena: Arena::new(filter != FilterMode::Footprint),
            parts: Vec::new(),
            ends: Vec::new(),
            stored: Stored::default(),
        }
    }

    /// How many segments may still be looked at.
    pub(super) fn work_left(&self) -> u64 {
        self.work_left
    }

    /// Divides a list that `uses` cells show. It starts with the first of `words`.
    pub(super) fn tree(
        &mut self,
        words: &[u32],
        curves: &[u32],
        uses: usize,
        lists: &mut Lists,
    ) -> Tree {
        self.arena.clear();
        self.parts.clear();
        self.ends.clear();
        let list = self.arena.decode(words, curves);
        self.push(list, self.whole);
        self.divide(uses);
        self.finish(0, 0, lists)
    }

    fn push(&mut self, list: List, region: Region) {
        self.parts.push(Part {
            list,
            shown: Shown::of(&self.arena, &list),
            region,
            quarters: None,
        });
    }

    /// Divides the one part, level by level, and takes back what is not worth it.
    fn divide(&mut self, uses: usize) {
        // Of what has no outline the same list serves all parts.
        let mut settled = Sums::default();
        self.stored.kept.clear();
        let mut share = 1.0;
        let mut sums = self.stored.with(settled, &self.parts, 0..1, share);
        let mut search = self.model.search(sums, uses);
        let mut work_left = match self.model.forced {
            true => u64::MAX,
            false => self.work_left.min(MAX_LIST_WORK),
        };
        // The parts of the present depth.
        let mut front = 0..1;
        for depth in 1..=self.model.max_depth {
            let parts = &self.parts;
            let is_plain = |at: &usize| !parts[*at].list.has_outlines;
            let plain = front.clone().filter(is_plain);
            settled = self.stored.with(settled, parts, plain, share);
            self.stored.keep();
            let outlined = parts[front.clone()].iter().map(|part| &part.list);
            let work = outlined.filter(|list| list.has_outlines).map(Arena::work);
            let work: u64 = work.sum();
            if work == 0 || !search.promises(depth, settled, sums) {
                break;
            }
            let Some(left) = work_left.checked_sub(work) else {
                break;
            };
            work_left = left;
            self.work_left = self.work_left.saturating_sub(work);
            share *= 0.25;
            let length = self.parts.len();
            for at in front {
                if self.parts[at].list.has_outlines {
                    self.quarter(at);
                }
            }
            front = length..self.parts.len();
            self.ends.push(length);
            sums = self.stored.with(settled, &self.parts, front.clone(), share);
            if !search.visit(depth, sums) {
                break;
            }
        }
        // Beyond the best depth there are no quarters.
        if let Some(&length) = self.ends.get(search.best_depth as usize) {
            self.parts.truncate(length);
        }
    }

    /// Appends the quarters of a part.
    fn quarter(&mut self, at: usize) {
        self.parts[at].quarters = Some(self.parts.len());
        let Part { list, region, .. } = self.parts[at];
        for regions in region.quarters() {
            let dilated = regions.map(|region| dilated(&region, &self.whole, self.filter));
            self.arena.trace(&list, dilated[0].y);
            for (region, Region { x, .. }) in regions.iter().zip(dilated) {
                let part = self.arena.within(&list, x);
                self.push(part, *region);
            }
        }
    }

    /// The tree of a part that is halved `depth` times. Quarters that show the same become one, but in footprint mode no list
    /// does: it serves what lies around it as far as the side of its own cell says.
    fn finish(&self, at: usize, depth: u32, lists: &mut Lists) -> Tree {
        let part = &self.parts[at];
        let Some(first) = part.quarters.filter(|first| *first < self.parts.len()) else {
            return Tree::Leaf(lists.word(&self.arena, &part.list, part.shown));
        };
        let quarters = [0, 1, 2, 3].map(|quarter| self.finish(first + quarter, depth + 1, lists));
        let merges = |word: u32| self.filter != FilterMode::Footprint || !has_list(word);
        match quarters[0].word() {
            Some(word) if merges(word) && quarters.iter().all(|other| *other == quarters[0]) => {
                Tree::Leaf(word)
            }
            _ => Tree::Split {
                whole: (self.has_levels && is_level(depth))
                    .then(|| lists.word(&self.arena, &part.list, part.shown)),
                quarters: Box::new(quarters),
            },
        }
    }
}

impl Stored {
    /// `sums` with the lists of some parts, of which those that are kept count already.
    fn with(
        &mut self,
        mut sums: Sums,
        parts: &[Part],
        some: impl IntoIterator<Item = usize>,
        share: f64,
    ) -> Sums {
        self.present.clear();
        for at in some {
            if let Shown::List { count, hash, .. } = parts[at].shown {
                sums.walked += share * depth::count(count);
                self.present.push((hash, count));
            }
        }
        // Equal lists are stored once.
        self.present.sort_unstable();
        self.present.dedup_by_key(|(hash, _)| *hash);
        let kept = &self.kept;
        self.present
            .retain(|(hash, _)| kept.binary_search(hash).is_err());
        let counts = self.present.iter().map(|&(_, count)| depth::count(count));
        sums.stored += counts.sum::<f64>();
        sums
    }

    /// Keeps the lists of the last sums.
    fn keep(&mut self) {
        if self.present.is_empty() {
            return;
        }
        self.kept.extend(self.present.iter().map(|(hash, _)| *hash));
        self.kept.sort_unstable();
    }
}
