//! A cell of the file, divided as deep as its content is worth.

use std::collections::BTreeSet;

use super::depth::{Model, Sums, count};
use super::dilated;
use super::list::List;
use super::lists::{Lists, Shown};
use super::outline::Region;
use crate::layout::{FilterMode, has_list};

/// A square of the picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Tree {
    /// It has one word.
    Leaf(u32),
    /// Its quarters, row by row.
    Split(Box<[Self; 4]>),
}

impl Tree {
    /// How often it is halved.
    pub(super) fn depth(&self) -> u32 {
        match self {
            Self::Leaf(_) => 0,
            Self::Split(quarters) => 1 + quarters.iter().map(Self::depth).max().unwrap_or(0),
        }
    }

    /// The part of it in column and row `at` of `2^depth`.
    pub(super) fn part(&self, depth: u32, at: [usize; 2]) -> &Self {
        match self {
            Self::Split(quarters) if depth > 0 => {
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
            Self::Split(_) => None,
        }
    }

    /// Writes it into the square of `2^depth` words at `at`, in rows of `pitch`.
    pub(super) fn fill(&self, words: &mut [u32], pitch: usize, [x, y]: [usize; 2], depth: u32) {
        match self {
            Self::Split(quarters) if depth > 0 => {
                let half = 1 << (depth - 1);
                let corners = [[x, y], [x + half, y], [x, y + half], [x + half, y + half]];
                for (quarter, corner) in quarters.iter().zip(corners) {
                    quarter.fill(words, pitch, corner, depth - 1);
                }
            }
            Self::Split(_) => {}
            Self::Leaf(word) => {
                for row in y..y + (1 << depth) {
                    words[row * pitch + x..][..1 << depth].fill(*word);
                }
            }
        }
    }
}

/// A part of a cell on the way to a tree.
struct Part {
    list: List,
    shown: Shown,
    region: Region,
    /// Place of the first of four quarters.
    quarters: Option<usize>,
}

impl Part {
    fn new(list: List, region: Region) -> Self {
        Self {
            shown: Shown::of(&list),
            list,
            region,
            quarters: None,
        }
    }
}

/// Divides a list that `uses` cells show.
pub(super) fn tree(
    list: List,
    whole: &Region,
    filter: FilterMode,
    model: &Model,
    uses: usize,
    lists: &mut Lists,
) -> Tree {
    let mut parts = vec![Part::new(list, *whole)];
    divide(&mut parts, whole, filter, model, uses);
    let merges = |word: u32| filter != FilterMode::Footprint || !has_list(word);
    finish(&parts, 0, &merges, lists)
}

/// Divides the one of `parts`, level by level, and takes back what is not worth it.
fn divide(parts: &mut Vec<Part>, whole: &Region, filter: FilterMode, model: &Model, uses: usize) {
    // Of what has no outline the same list serves all parts.
    let mut settled = Sums::default();
    let mut kept = BTreeSet::new();
    let mut front = vec![0];
    let mut share = 1.0;
    let first = settled.with(parts, &front, share, &mut BTreeSet::new());
    let mut search = model.search(first, uses);
    let mut levels = Vec::new();
    for depth in 1..=model.max_depth {
        let length = parts.len();
        let (outlined, plain): (Vec<usize>, Vec<usize>) =
            front.iter().partition(|&&at| parts[at].list.has_outlines());
        settled = settled.with(parts, &plain, share, &mut kept);
        if outlined.is_empty() {
            break;
        }
        share *= 0.25;
        front.clear();
        for &at in &outlined {
            parts[at].quarters = Some(parts.len());
            for region in parts[at].region.quarters() {
                let list = parts[at].list.within(&dilated(&region, whole, filter));
                front.push(parts.len());
                parts.push(Part::new(list, region));
            }
        }
        levels.push((length, outlined));
        let sums = settled.with(parts, &front, share, &mut kept.clone());
        if !search.visit(depth, sums) {
            break;
        }
    }
    if let Some((length, outlined)) = levels.get(search.best_depth as usize) {
        parts.truncate(*length);
        for &at in outlined {
            parts[at].quarters = None;
        }
    }
}

impl Sums {
    /// With the lists of some parts; `seen` has the hashes of those that are stored already.
    fn with(
        mut self,
        parts: &[Part],
        some: &[usize],
        share: f64,
        seen: &mut BTreeSet<u64>,
    ) -> Self {
        for &at in some {
            if let Shown::List { commands, hash, .. } = &parts[at].shown {
                self.walked += share * count(commands.len());
                if seen.insert(*hash) {
                    self.stored += count(commands.len());
                }
            }
        }
        self
    }
}

/// The tree of a part. Quarters that show the same become one where `merges` says so of their word:
/// in footprint mode a list serves what lies around it as far as the side of its own cell says.
fn finish(parts: &[Part], at: usize, merges: &impl Fn(u32) -> bool, lists: &mut Lists) -> Tree {
    let part = &parts[at];
    let Some(first) = part.quarters else {
        return Tree::Leaf(lists.word(&part.shown));
    };
    let quarters = [0, 1, 2, 3].map(|quarter| finish(parts, first + quarter, merges, lists));
    match quarters[0].word() {
        Some(word) if merges(word) && quarters.iter().all(|quarter| *quarter == quarters[0]) => {
            Tree::Leaf(word)
        }
        _ => Tree::Split(Box::new(quarters)),
    }
}
