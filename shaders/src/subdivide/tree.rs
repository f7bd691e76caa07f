//! A cell of the file, divided as deep as its content is worth.

use std::collections::BTreeSet;

use super::depth::{self, Model, Sums};
use super::dilated;
use super::grid::is_level;
use super::list::{Arena, List};
use super::lists::{Lists, Shown};
use super::outline::Region;
use crate::layout::{FilterMode, cell, has_list};

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
    /// What the present cell's parts show.
    arena: Arena,
    commands: Vec<[u32; 4]>,
    parts: Vec<Part>,
}

impl<'a> Divider<'a> {
    /// `whole` is a cell of the file.
    pub(super) fn new(
        whole: Region,
        filter: FilterMode,
        has_levels: bool,
        model: &'a Model,
    ) -> Self {
        Self {
            whole,
            filter,
            has_levels,
            model,
            arena: Arena::default(),
            commands: Vec::new(),
            parts: Vec::new(),
        }
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
        self.commands.clear();
        self.parts.clear();
        let list = self.arena.decode(words, curves);
        self.push(list, self.whole);
        self.divide(uses);
        self.finish(0, 0, lists)
    }

    fn push(&mut self, list: List, region: Region) {
        self.parts.push(Part {
            list,
            shown: Shown::of(&self.arena, &list, &mut self.commands),
            region,
            quarters: None,
        });
    }

    /// Divides the one part, level by level, and takes back what is not worth it.
    fn divide(&mut self, uses: usize) {
        // Of what has no outline the same list serves all parts.
        let mut settled = Sums::default();
        let mut kept = BTreeSet::new();
        let mut front = vec![0];
        let mut share = 1.0;
        let mut sums = settled.with(&self.parts, &front, share, &kept);
        let mut search = self.model.search(sums, uses);
        let mut levels = Vec::new();
        for depth in 1..=self.model.max_depth {
            let length = self.parts.len();
            let has_outlines = |at: &usize| self.arena.has_outlines(self.parts[*at].list.nodes);
            let (outlined, plain): (Vec<usize>, Vec<usize>) =
                front.iter().partition(|at| has_outlines(at));
            settled = settled.with(&self.parts, &plain, share, &kept);
            kept.extend(hashes(&self.parts, &plain));
            if outlined.is_empty() || !search.promises(depth, settled, sums) {
                break;
            }
            share *= 0.25;
            for &at in &outlined {
                self.quarter(at);
            }
            levels.push((length, outlined));
            front = (length..self.parts.len()).collect();
            sums = settled.with(&self.parts, &front, share, &kept);
            if !search.visit(depth, sums) {
                break;
            }
        }
        if let Some((length, outlined)) = levels.get(search.best_depth as usize) {
            self.parts.truncate(*length);
            for &at in outlined {
                self.parts[at].quarters = None;
            }
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
        let Some(first) = part.quarters else {
            return Tree::Leaf(lists.word(part.shown, &self.commands));
        };
        let quarters = [0, 1, 2, 3].map(|quarter| self.finish(first + quarter, depth + 1, lists));
        let merges = |word: u32| self.filter != FilterMode::Footprint || !has_list(word);
        match quarters[0].word() {
            Some(word) if merges(word) && quarters.iter().all(|other| *other == quarters[0]) => {
                Tree::Leaf(word)
            }
            _ => Tree::Split {
                whole: (self.has_levels && is_level(depth))
                    .then(|| lists.word(part.shown, &self.commands)),
                quarters: Box::new(quarters),
            },
        }
    }
}

impl Sums {
    /// With the lists of some parts, of which those in `kept` are stored already.
    fn with(mut self, parts: &[Part], some: &[usize], share: f64, kept: &BTreeSet<u64>) -> Self {
        let mut new = Vec::new();
        for &at in some {
            if let Shown::List { commands, hash, .. } = parts[at].shown {
                let count = commands.range().len();
                self.walked += share * depth::count(count);
                new.push((hash, count));
            }
        }
        // Equal lists are stored once.
        new.sort_unstable();
        new.dedup_by_key(|(hash, _)| *hash);
        new.retain(|(hash, _)| !kept.contains(hash));
        self.stored += new
            .iter()
            .map(|&(_, count)| depth::count(count))
            .sum::<f64>();
        self
    }
}

fn hashes(parts: &[Part], some: &[usize]) -> impl Iterator<Item = u64> {
    some.iter().filter_map(|&at| match parts[at].shown {
        Shown::List { hash, .. } => Some(hash),
        Shown::Paint(_) => None,
    })
}
