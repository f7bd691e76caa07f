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
mod list;
mod lists;
mod outline;
mod tree;

use std::collections::BTreeMap;

use vtex_format::{CellWord, Features, VtexFile};

use crate::layout::{FilterMode, cell};
use depth::Model;
use grid::{Grid, Picture};
use lists::Lists;
use outline::Region;
use tree::{Divider, Tree};

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
    let mut made = Subdivision::default();
    while let Some(model) = next {
        if let Some(subdivision) = divide(file, filter, &model) {
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
fn divide(file: &VtexFile, filter: FilterMode, model: &Model) -> Option<Subdivision> {
    let mut uses: BTreeMap<u32, usize> = BTreeMap::new();
    for &word in &file.cells {
        *uses.entry(word).or_default() += 1;
    }
    // A walk through groups is for few samples, and there are as many walks on any level.
    let has_groups = file.spec.features & Features::GROUPS != 0;
    let has_levels = filter == FilterMode::Footprint && !has_groups;
    let mut divider = Divider::new(whole_cell(file), filter, has_levels, model);
    let mut lists = Lists::default();
    let mut picture = Picture {
        size: file.meta.grid.size_cells.map(|count| count as usize),
        has_levels,
        ..Picture::default()
    };
    let mut known: BTreeMap<u32, usize> = BTreeMap::new();
    let mut leaves: BTreeMap<u32, usize> = BTreeMap::new();
    for &word in &file.cells {
        let index = known.entry(word).or_insert_with(|| {
            let tree = match CellWord::decode(word) {
                Some(CellWord::List { offset_words }) => {
                    let words = file.entries.get(offset_words as usize..).unwrap_or(&[]);
                    let uses = uses.get(&word).copied().unwrap_or(1);
                    divider.tree(words, &file.curves, uses, &mut lists)
                }
                Some(CellWord::Paint { paint }) => {
                    Tree::Leaf(cell::SOLID << cell::TAG_SHIFT | paint)
                }
                _ => Tree::Leaf(cell::EMPTY),
            };
            let next = picture.trees.len();
            let index = match tree.word() {
                Some(word) => *leaves.entry(word).or_insert(next),
                None => next,
            };
            if index == next {
                picture.trees.push(tree);
            }
            index
        });
        picture.cells.push(*index);
    }
    // As many cells as the grid has, which only a file that no validator lets in has not.
    let cells = picture.size[0] * picture.size[1];
    if picture.cells.len() < cells {
        picture.cells.resize(cells, picture.trees.len());
        picture.trees.push(Tree::Leaf(cell::EMPTY));
    }
    Some(Subdivision {
        grid: picture.grid()?,
        commands: lists.commands,
    })
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

/// What the list of a fine cell serves, where `whole` is a cell of the file.
fn dilated(fine: &Region, whole: &Region, filter: FilterMode) -> Region {
    if filter == FilterMode::Footprint {
        let side = fine.x[1] - fine.x[0];
        fine.dilated(side * f64::from(cell::OVERLAP) / 16.0)
            .intersection(whole)
    } else {
        *fine
    }
}

#[cfg(test)]
mod clips_and_groups_tests;
#[cfg(test)]
mod tests;
