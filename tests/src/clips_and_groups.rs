//! Random trees of clips, groups and masks: as a file's lists, and as what they are to show.
//!
//! The evaluators walk lists; the reference here never sees one, so that what encodes trees and
//! what walks lists are held against each other.

mod encode;
mod reference;
mod tree;

use vtex_format::{
    CellWord, CurveHeader, CurveLattice, Entry, Grid, MAX_BLEND_DEPTH, Meta, PaintRecord, SpecKey,
    VtexFile, list_blend_depth,
};

use crate::random::Random;
pub use reference::Lens;
pub use tree::{Clip, Compositing, Group, Mask, Node, Part, Wants};

/// Lattice steps along a cell.
const TEXELS_PER_CELL: u32 = 4;
/// Records that a random tree names.
const RECORDS: usize = tree::COUNT as usize;
/// How far the boxes of records go beyond their cells, in cells.
const MARGIN_CELLS: f32 = 0.25;

/// A row of cells, each with a tree of its own.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// What shows in each cell, back to front.
    pub cells: Vec<Vec<Node>>,
    /// Straight, sRGB-encoded colours.
    pub paints: Vec<[f32; 4]>,
    /// Curve records, in units of a cell's box.
    pub records: Vec<Vec<u32>>,
}

impl Drawing {
    /// A drawing of `cells` random trees of what `wants` names.
    ///
    /// # Panics
    /// Never: some tree is shallow enough.
    pub fn random(seed: u64, cells: u32, wants: Wants) -> Self {
        let mut r = Random::new(seed);
        let records = (0..8).map(|_| random_record(&mut r)).collect();
        let paints = (0..8).map(|_| random_paint(&mut r)).collect();
        let tree = |_| random_tree(&mut r, wants, MAX_BLEND_DEPTH);
        Self {
            cells: (0..cells).map(tree).collect(),
            paints,
            records,
        }
    }

    /// The drawing as a file.
    ///
    /// # Panics
    /// When a tree is too large for a list.
    pub fn file(&self) -> VtexFile {
        let columns = u32::try_from(self.cells.len()).expect("few cells");
        let grid = Grid::new([columns, 1], TEXELS_PER_CELL);
        let solid = |color: &[f32; 4]| PaintRecord::solid(*color);
        let mut file = VtexFile {
            paints: self.paints.iter().map(solid).collect(),
            cells: Vec::new(),
            ..VtexFile::blank(Meta::new(grid.cell_from_uv_scale, grid))
        };
        file.meta.curve_lattice = Some(lattice());
        let mut places = Vec::new();
        for record in &self.records {
            places.push(u32::try_from(file.curves.len()).expect("short records"));
            file.curves.extend(record);
        }
        for nodes in &self.cells {
            let mut entries = encode::entries(nodes, &places);
            for entry in entries.iter_mut().filter(|entry| entry.kind.draws()) {
                entry.opaque = self.paints[entry.index as usize][3] >= 1.0;
            }
            let offset_words = u32::try_from(file.entries.len()).expect("short lists");
            let cell = match entries.last_mut() {
                None => CellWord::Empty,
                Some(last) => {
                    last.last = true;
                    CellWord::List { offset_words }
                }
            };
            file.cells.push(cell.encode().expect("short lists"));
            let words = entries
                .iter()
                .flat_map(|entry| entry.encode().expect("sound"));
            file.entries.extend(words);
        }
        file.spec = SpecKey::for_file(&file);
        file
    }
}

/// A tree that needs at most `depth` levels of the blend stack.
fn random_tree(r: &mut Random, wants: Wants, depth: u32) -> Vec<Node> {
    loop {
        let nodes = tree::random_nodes(r, wants, 4);
        let entries = encode::entries(&nodes, &[0; RECORDS]);
        if list_blend_depth(&entries).is_ok_and(|taken| taken <= depth) {
            return nodes;
        }
    }
}

/// The list of a random tree, none of its entries marked last or opaque; branches name some of
/// `records`, the places of curve records, of which there may be none where no clip is wanted.
pub(crate) fn random_list(r: &mut Random, wants: Wants, records: &[u32], depth: u32) -> Vec<Entry> {
    let mut places = [0; RECORDS];
    if let Some(count) = u32::try_from(records.len()).ok().filter(|&count| count > 0) {
        places = places.map(|_| records[r.below(count) as usize]);
    }
    encode::entries(&random_tree(r, wants, depth), &places)
}

/// The lattice of all records.
///
/// # Panics
/// Never: the margin is in range.
pub fn lattice() -> CurveLattice {
    CurveLattice::new(MARGIN_CELLS).expect("in range")
}

fn random_paint(r: &mut Random) -> [f32; 4] {
    let alpha = if r.below(2) == 0 {
        1.0
    } else {
        r.between(0.2, 0.9)
    };
    let [red, green, blue] = [(); 3].map(|()| r.between(0.02, 0.98));
    [red, green, blue, alpha]
}

/// A closed polygon around most of the cell, or of three corners anywhere in the box.
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "16 bits"
)]
fn random_record(r: &mut Random) -> Vec<u32> {
    let units = lattice().box_units() as f32;
    let count = 3 + r.below(4);
    let around = r.below(4) > 0;
    let corner = |place: u32| {
        let turn = (place as f32 + r.unit()) / count as f32 * std::f32::consts::TAU;
        let far = r.between(0.2, 0.5);
        let at = if around {
            [0.5 + far * turn.cos(), 0.5 + far * turn.sin()]
        } else {
            [r.unit(), r.unit()]
        };
        at.map(|x| (x * units) as u32)
    };
    let corners: Vec<[u32; 2]> = (0..count).map(corner).collect();
    polygon_record(&corners)
}

/// The record of the closed polygon through `corners`, in units of a cell's box.
///
/// # Panics
/// Never: a polygon has few corners.
pub fn polygon_record(corners: &[[u32; 2]]) -> Vec<u32> {
    let mut by_direction = [const { Vec::new() }; 2];
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let down = to[1] > from[1];
        let [a, b] = if down { [from, to] } else { [to, from] };
        by_direction[usize::from(!down)].extend([a, b].map(|[x, y]| x | y << 16));
    }
    let count = |words: &Vec<u32>| u32::try_from(words.len() / 2).expect("few corners");
    let header = CurveHeader {
        line_count: count(&by_direction[0]) + count(&by_direction[1]),
        down_line_count: count(&by_direction[0]),
        ..CurveHeader::default()
    };
    let head = header.encode().expect("few corners");
    [&head[..], &by_direction[0], &by_direction[1]].concat()
}
