//! Finer cells than the file's, made when a texture is packed.
//!
//! A file holds coarse cells, which are small; a lookup wants fine ones, in which hardly an edge is
//! left to test. A fine cell keeps of its cell's list the segments, as they are, that its lookups
//! can tell apart. Nothing is cut or rounded, so every lookup gets the result that the coarse cell
//! gives.

mod clearance;
mod clip;
mod commands;
mod depth;
mod group;
mod list;
mod outline;

use std::collections::BTreeMap;

use vtex_format::{CellWord, VtexFile};

use crate::layout::{FilterMode, cell};
use commands::Order;
use list::List;
use outline::Region;

/// The cells that evaluators read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Subdivision {
    /// How often the file's cells are halved.
    pub(crate) depth: u32,
    /// One word a fine cell, row by row, as [`cell`] says.
    pub(crate) words: Vec<u32>,
    /// All lists' commands.
    pub(crate) commands: Vec<[u32; 4]>,
}

/// `halvings` as in [`crate::PackOptions`].
pub(crate) fn subdivide(file: &VtexFile, filter: FilterMode, halvings: Option<u32>) -> Subdivision {
    let depth = match halvings {
        Some(halvings) => halvings.min(depth::MAX_DEPTH),
        None => depth::choose(file, filter),
    };
    let [columns, rows] = file.meta.grid.size_cells.map(|count| count as usize);
    let whole = whole_cell(file);
    let mut build = Build {
        whole,
        filter,
        pitch: columns << depth,
        words: vec![0; (columns << depth) * (rows << depth)],
        commands: Vec::new(),
        shared: BTreeMap::new(),
    };
    for (index, &word) in file.cells.iter().enumerate() {
        let at = [(index % columns) << depth, (index / columns) << depth];
        match CellWord::decode(word) {
            Some(CellWord::List { offset_words }) => {
                // Lists of one cell are alike, those of two hardly ever.
                build.shared.clear();
                build.list(&list_of(file, offset_words), &whole, at, depth);
            }
            Some(CellWord::Paint { paint }) => {
                build.fill(at, depth, cell::SOLID << cell::TAG_SHIFT | paint);
            }
            _ => {}
        }
    }
    if filter == FilterMode::Footprint {
        clearance::write(&mut build.words, build.pitch);
    }
    Subdivision {
        depth,
        words: build.words,
        commands: build.commands,
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

fn list_of(file: &VtexFile, offset_words: u32) -> List {
    let words = file.entries.get(offset_words as usize..).unwrap_or(&[]);
    List::decode(words, &file.curves)
}

struct Build {
    /// Of a cell of the file.
    whole: Region,
    filter: FilterMode,
    pitch: usize,
    words: Vec<u32>,
    commands: Vec<[u32; 4]>,
    /// Where the lists of this cell's parts lie.
    shared: BTreeMap<Vec<[u32; 4]>, u32>,
}

impl Build {
    fn fill(&mut self, [x, y]: [usize; 2], level: u32, word: u32) {
        let side = 1 << level;
        for row in y..y + side {
            let first = row * self.pitch + x;
            self.words[first..first + side].fill(word);
        }
    }

    fn list(&mut self, list: &List, region: &Region, [x, y]: [usize; 2], level: u32) {
        if level > 0 && list.has_outlines() {
            let half = 1 << (level - 1);
            let corners = [[x, y], [x + half, y], [x, y + half], [x + half, y + half]];
            for (quarter, corner) in region.quarters().iter().zip(corners) {
                self.list(
                    &list.within(&dilated(quarter, &self.whole, self.filter)),
                    quarter,
                    corner,
                    level - 1,
                );
            }
            return;
        }
        let word = if list.is_empty() {
            cell::EMPTY
        } else if let Some(paint) = list.solid() {
            cell::SOLID << cell::TAG_SHIFT | paint
        } else {
            let (tag, order) = if list.has_groups() {
                (cell::GROUPS, Order::BackToFront)
            } else {
                (cell::LIST, Order::FrontToBack)
            };
            let commands = list.commands(order);
            let next = u32::try_from(self.commands.len()).unwrap_or(cell::PAYLOAD_MASK);
            let first = *self.shared.entry(commands).or_insert_with_key(|commands| {
                self.commands.extend(commands);
                next
            });
            tag << cell::TAG_SHIFT | first.min(cell::PAYLOAD_MASK)
        };
        self.fill([x, y], level, word);
    }
}

#[cfg(test)]
mod clips_and_groups_tests;
#[cfg(test)]
mod tests;
