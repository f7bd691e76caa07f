//! Finer cells than the file's, made when a texture is packed.
//!
//! A file holds coarse cells, which are small; a lookup wants fine ones, in which hardly an edge is
//! left to test. A fine cell keeps of its cell's list the segments, as they are, that its lookups
//! can tell apart. Nothing is cut or rounded, so every lookup gets the answer that the coarse cell
//! gives.

mod clip;
mod depth;
mod group;
mod items;
mod list;
mod outline;

use std::collections::BTreeMap;

use vtex_format::{CellWord, VtexFile};

use crate::layout::cell;
use items::Order;
use list::List;
use outline::Region;

/// The cells that evaluators read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Refined {
    /// How often the file's cells are halved.
    pub(crate) depth: u32,
    /// One word a fine cell, row by row: the tags of [`cell`], a list's payload counts items.
    pub(crate) words: Vec<u32>,
    /// All lists' items.
    pub(crate) items: Vec<[u32; 4]>,
}

/// `distances` says that lookups measure how far edges are, not only on which side; `halvings` as in
/// [`crate::PackOptions`].
pub(crate) fn refine(file: &VtexFile, distances: bool, halvings: Option<u32>) -> Refined {
    let depth = match halvings {
        Some(halvings) => halvings.min(depth::MAX_DEPTH),
        None => depth::choose(file, distances),
    };
    let [columns, rows] = file.meta.grid.size_cells.map(|count| count as usize);
    let mut build = Build {
        distances,
        pitch: columns << depth,
        words: vec![0; (columns << depth) * (rows << depth)],
        items: Vec::new(),
        shared: BTreeMap::new(),
    };
    let whole = whole_cell(file, distances);
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
    Refined {
        depth,
        words: build.words,
        items: build.items,
    }
}

/// A cell of the file in units of its box.
fn whole_cell(file: &VtexFile, distances: bool) -> Region {
    let lattice = file.meta.curve_lattice;
    let margin = f64::from(lattice.map_or(0, |lattice| lattice.margin_units));
    let units = f64::from(lattice.map_or(1, |lattice| lattice.units_per_cell));
    Region {
        x: [margin, margin + units],
        y: [margin, margin + units],
        reach: if distances { margin } else { 0.0 },
    }
}

fn list_of(file: &VtexFile, offset_words: u32) -> List {
    let words = file.entries.get(offset_words as usize..).unwrap_or(&[]);
    List::decode(words, &file.curves)
}

struct Build {
    /// As of [`refine`].
    distances: bool,
    pitch: usize,
    words: Vec<u32>,
    items: Vec<[u32; 4]>,
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
                self.list(&list.within(quarter), quarter, corner, level - 1);
            }
            return;
        }
        let word = if list.is_empty() {
            cell::EMPTY
        } else if let Some(paint) = list.solid() {
            cell::SOLID << cell::TAG_SHIFT | paint
        } else {
            let (tag, order) = if list.needs_frames(self.distances) {
                (cell::SCOPES, Order::BackToFront)
            } else {
                (cell::LIST, Order::FrontToBack)
            };
            let items = list.items(order);
            let next = u32::try_from(self.items.len()).unwrap_or(cell::PAYLOAD_MASK);
            let first = *self.shared.entry(items).or_insert_with_key(|items| {
                self.items.extend(items);
                next
            });
            tag << cell::TAG_SHIFT | first.min(cell::PAYLOAD_MASK)
        };
        self.fill([x, y], level, word);
    }
}

#[cfg(test)]
mod scope_tests;
#[cfg(test)]
mod tests;
