//! Finer cells than the file's, made when a texture is packed.
//!
//! A file holds coarse cells, which are small; a lookup wants fine ones, in which hardly an edge is
//! left to test. A fine cell keeps of its cell's list the segments, as they are, that its lookups
//! can tell apart. Nothing is cut or rounded, so every lookup gets the result that the coarse cell
//! gives.
//!
//! Each cell is divided as deep as its content is worth ([`depth`], [`tree`]). Evaluators read a grid
//! of base cells, and a block of finer ones where a base cell shows more than a word says ([`grid`]).

mod clearance;
mod clip;
mod commands;
mod depth;
mod grid;
mod group;
mod hash;
mod list;
mod lists;
mod outline;
mod tree;

use std::collections::BTreeMap;

use vtex_format::{CellWord, Features, VtexFile};

use crate::layout::{FilterMode, cell};
use depth::Model;
use grid::Picture;
pub(crate) use grid::{Grid, LARGEST, SMALLEST, Side, base_size, block_words};
use lists::Lists;
use outline::Region;
use tree::{Divider, Tree};

/// What dividing all lists may look at, as `Arena::work` counts: beyond it lists stay as they are. Of 276
/// drawings the one that needs most takes 8 million.
const MAX_WORK: u64 = 1 << 26;

/// The cells that evaluators read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Subdivision {
    /// Base cells and blocks.
    pub(crate) grid: Grid,
    /// All lists' commands.
    pub(crate) commands: Vec<[u32; 4]>,
}

impl Subdivision {
    fn bytes(&self) -> usize {
        4 * self.grid.words.len() + 16 * self.commands.len()
    }
}

/// `halvings` as in [`crate::PackOptions`].
pub(crate) fn subdivide(file: &VtexFile, filter: FilterMode, halvings: Option<u32>) -> Subdivision {
    let mut next = Some(Model::new(file, filter, halvings));
    let mut work_left = MAX_WORK;
    let mut made = Subdivision::default();
    while let Some(model) = next {
        if let Some(subdivision) = divide(file, filter, &model, &mut work_left) {
            let fits = halvings.is_some() || subdivision.bytes() <= depth::MAX_BYTES;
            made = subdivision;
            if fits {
                break;
            }
        }
        next = model.coarser();
    }
    if filter == FilterMode::Footprint {
        clearance::write(&mut made.grid);
    }
    made
}

/// `None` where the words cannot name all blocks.
fn divide(
    file: &VtexFile,
    filter: FilterMode,
    model: &Model,
    work_left: &mut u64,
) -> Option<Subdivision> {
    // A walk through groups is for few samples, and there are as many walks on any level.
    let has_groups = file.spec.features & Features::GROUPS != 0;
    let has_levels = filter == FilterMode::Footprint && !has_groups;
    let mut divider = Divider::new(whole_cell(file), filter, has_levels, model, *work_left);
    let mut lists = Lists::default();
    let mut picture = Picture {
        size: file.meta.grid.size_cells.map(|count| count as usize),
        has_levels,
        narrows: filter != FilterMode::Footprint,
        ..Picture::default()
    };
    let uses = Uses::of(file);
    let mut known = Known::of(file);
    let mut leaves: BTreeMap<u32, u32> = BTreeMap::new();
    picture.cells.reserve_exact(file.cells.len());
    for &word in &file.cells {
        let shown = CellWord::decode(word).unwrap_or(CellWord::Empty);
        let known = known.tree(shown);
        if *known == Known::NONE {
            let tree = match shown {
                CellWord::List { offset_words } => {
                    let words = file.entries.get(offset_words as usize..).unwrap_or(&[]);
                    let uses = uses.of_list(offset_words);
                    divider.tree(words, &file.curves, uses, &mut lists)
                }
                CellWord::Paint { paint } => Tree::Leaf(cell::SOLID << cell::TAG_SHIFT | paint),
                CellWord::Empty => Tree::Leaf(cell::EMPTY),
            };
            let next = u32::try_from(picture.trees.len()).ok()?;
            *known = match tree.word() {
                Some(word) => *leaves.entry(word).or_insert(next),
                None => next,
            };
            if *known == next {
                picture.trees.push(tree);
            }
        }
        picture.cells.push(*known);
    }
    // As many cells as the grid has, which only a file that no validator lets in has not.
    let cells = picture.size[0] * picture.size[1];
    if picture.cells.len() < cells {
        let next = u32::try_from(picture.trees.len()).ok()?;
        picture.cells.resize(cells, next);
        picture.trees.push(Tree::Leaf(cell::EMPTY));
    }
    *work_left = divider.work_left();
    Some(Subdivision {
        grid: picture.grid()?,
        commands: lists.commands,
    })
}

/// How many cells name each list, by its first word.
struct Uses(Vec<u32>);

impl Uses {
    fn of(file: &VtexFile) -> Self {
        let mut uses = vec![0; file.entries.len()];
        for &word in &file.cells {
            if let Some(CellWord::List { offset_words }) = CellWord::decode(word)
                && let Some(count) = uses.get_mut(offset_words as usize)
            {
                *count += 1;
            }
        }
        Self(uses)
    }

    fn of_list(&self, offset_words: u32) -> usize {
        let count = self.0.get(offset_words as usize);
        count.map_or(1, |&count| count as usize)
    }
}

/// The trees of what cells show: one for each list, each paint and nothing. What no file names that a
/// validator lets in shares the last place.
struct Known {
    lists: Vec<u32>,
    paints: Vec<u32>,
    other: u32,
}

impl Known {
    const NONE: u32 = u32::MAX;

    fn of(file: &VtexFile) -> Self {
        Self {
            lists: vec![Self::NONE; file.entries.len()],
            paints: vec![Self::NONE; file.paints.len()],
            other: Self::NONE,
        }
    }

    fn tree(&mut self, shown: CellWord) -> &mut u32 {
        let known = match shown {
            CellWord::List { offset_words } => self.lists.get_mut(offset_words as usize),
            CellWord::Paint { paint } => self.paints.get_mut(paint as usize),
            CellWord::Empty => None,
        };
        known.unwrap_or(&mut self.other)
    }
}

/// A cell of the file in units of its box.
fn whole_cell(file: &VtexFile) -> Region {
    let lattice = file.meta.curve_lattice;
    let margin = f64::from(lattice.map_or(0, |lattice| lattice.margin_units));
    let units = f64::from(lattice.map_or(1, |lattice| lattice.units_per_cell));
    Region {
        x: [margin, margin + units],
        y: [margin, margin + units],
    }
}

#[cfg(test)]
mod tests;
