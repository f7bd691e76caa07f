//! From a lowered outline to every cell it passes through or fills.

use std::collections::BTreeMap;
use std::ops::Range;

use kurbo::Point;
use vtex_format::CurveLattice;

use super::{
    clip::{CellBox, clip},
    lower::{LoweredOutline, Segment},
};

/// What a shape is to the cells. Cells are indices, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ShapeCurves {
    /// Cells whose whole box has one winding, and which, ascending.
    pub(crate) covered: Vec<(u32, i32)>,
    /// Cells with some outline in their box, ascending.
    pub(crate) edges: Vec<(u32, CellCurves)>,
}

/// A shape inside one cell's box, in units from the box's top left corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CellCurves {
    /// Winding at the box's top left corner.
    pub(crate) base: i32,
    /// Heights on the box's left edge at which the winding changes, ascending, and by how much.
    pub(crate) steps: Vec<(f64, i32)>,
    /// What of the outline lies in the box.
    pub(crate) segments: Vec<Segment>,
}

/// Where the cells are and how fine the cut is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutParams {
    /// Columns and rows.
    pub(crate) size_cells: [u32; 2],
    /// The lattice whose units outlines are in; its origin is the grid's.
    pub(crate) lattice: CurveLattice,
    /// A quadratic that stays within this many units of its chord becomes a line.
    pub(crate) flatness_units: f64,
}

impl CutParams {
    fn cell_units(&self) -> f64 {
        f64::from(self.lattice.units_per_cell)
    }

    fn margin(&self) -> f64 {
        f64::from(self.lattice.margin_units)
    }

    fn box_of(&self, column: u32, row: u32) -> CellBox {
        let corner = |index: u32| f64::from(index) * self.cell_units() - self.margin();
        CellBox {
            origin: Point::new(corner(column), corner(row)),
            size: f64::from(self.lattice.box_units()),
            flatness: self.flatness_units,
        }
    }

    /// Cells along an axis of `count` whose boxes hold more than an end of `[low, high]`.
    fn cells_along(&self, low: f64, high: f64, count: u32) -> Range<u32> {
        let first = (low - self.margin()) / self.cell_units();
        let end = (high + self.margin()) / self.cell_units();
        clamp_index(first.floor(), count)..clamp_index(end.ceil(), count)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the grid"
)]
fn clamp_index(x: f64, count: u32) -> u32 {
    x.clamp(0.0, f64::from(count)) as u32
}

/// Cuts `outline` to every cell.
pub(crate) fn cut_to_cells(outline: &LoweredOutline, params: &CutParams) -> ShapeCurves {
    let [_, row_count] = params.size_cells;
    let mut by_row: Vec<Vec<&Segment>> = vec![Vec::new(); row_count as usize];
    for segment in &outline.segments {
        let rows = params.cells_along(segment.start.y, segment.end.y, row_count);
        for row in rows {
            by_row[row as usize].push(segment);
        }
    }
    let mut shape = ShapeCurves::default();
    for (row, mut segments) in (0_u32..).zip(by_row) {
        segments.sort_by(|a, b| a.x_min().total_cmp(&b.x_min()));
        cut_row(&segments, row, params, &mut shape);
    }
    shape
}

/// `segments` are those that reach into the row's boxes, by their smallest x.
fn cut_row(segments: &[&Segment], row: u32, params: &CutParams, shape: &mut ShapeCurves) {
    let low = segments.first().map_or(f64::INFINITY, |s| s.x_min());
    let high = segments
        .iter()
        .fold(f64::NEG_INFINITY, |x, s| x.max(s.x_max()));
    let mut waiting = segments.iter().copied().peekable();
    let mut active: Vec<&Segment> = Vec::new();
    // What lies left of all boxes to come.
    let mut passed = LeftEdge::default();
    for column in params.cells_along(low, high, params.size_cells[0]) {
        let cell = params.box_of(column, row);
        let right = cell.origin.x + cell.size;
        while let Some(segment) = waiting.next_if(|s| s.x_min() < right) {
            active.push(segment);
        }
        active.retain(|segment| {
            let keep = segment.x_max() > cell.origin.x;
            if !keep {
                passed.add(segment, clip(segment, &cell).left, cell.size);
            }
            keep
        });
        let index = row * params.size_cells[0] + column;
        let curves = cut_cell(&active, passed.clone(), &cell);
        if !curves.segments.is_empty() || !curves.steps.is_empty() {
            shape.edges.push((index, curves));
        } else if curves.base != 0 {
            shape.covered.push((index, curves.base));
        }
    }
}

fn cut_cell(active: &[&Segment], mut left: LeftEdge, cell: &CellBox) -> CellCurves {
    let mut segments = Vec::new();
    for segment in active {
        let clipped = clip(segment, cell);
        left.add(segment, clipped.left, cell.size);
        segments.extend(clipped.inside);
    }
    CellCurves {
        base: left.base,
        steps: left
            .steps
            .into_iter()
            .map(|(height, change)| (f64::from(height), change))
            .collect(),
        segments,
    }
}

/// The winding along a box's left edge: a step function of the height.
#[derive(Clone, Debug, Default)]
struct LeftEdge {
    base: i32,
    /// Height in units to change, none of them zero: where a contour goes on left of the box its
    /// segments' ends cancel.
    steps: BTreeMap<u16, i32>,
}

impl LeftEdge {
    fn add(&mut self, segment: &Segment, heights: Option<[f64; 2]>, size: f64) {
        if let Some([top, bottom]) = heights {
            self.change(top, segment.direction, size);
            self.change(bottom, -segment.direction, size);
        }
    }

    fn change(&mut self, height: f64, change: i32, size: f64) {
        if height <= 0.0 {
            self.base += change;
        } else if height < size {
            let entry = self.steps.entry(to_u16(height));
            let sum = *entry.and_modify(|old| *old += change).or_insert(change);
            if sum == 0 {
                self.steps.remove(&to_u16(height));
            }
        }
    }
}

/// A coordinate of a box, which is an integer of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "boxes are at most 65535 units wide"
)]
pub(super) fn to_u16(x: f64) -> u16 {
    x as u16
}
