//! Cutting a lowered outline to every cell that it crosses or fills.
//!
//! Rows of cells are swept from left to right. Segments wait until a box reaches them, are active
//! while they meet boxes, and have passed when they lie to the left of all boxes to come. Passed
//! segments are never looked at again: they stay as steps in a running sum.

use std::ops::Range;

use vtex_format::{
    CurveLattice,
    cut::{CellBox, CellCurves, Point, Segment},
};

use super::lower::{self, LoweredOutline};

/// Where a shape shows. Cells are indices, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ShapeCurves {
    /// Cells whose whole box has one winding that is not 0, with that winding, ascending.
    pub(crate) covered: Vec<(u32, i32)>,
    /// Cells with a part of the outline in their box, ascending.
    pub(crate) edges: Vec<(u32, CellCurves)>,
}

/// The cells and the precision of the cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CutParams {
    /// Columns and rows.
    pub(crate) size_cells: [u32; 2],
    /// The curve lattice: outlines are in its units. Its origin is that of the grid.
    pub(crate) lattice: CurveLattice,
    /// A quadratic within this many units of its chord becomes a line.
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
        CellBox::of_cell([column, row], self.lattice, self.flatness_units)
    }

    /// The cells along an axis of `count` cells whose boxes overlap `[low, high]`. Boxes that only
    /// touch an end of it are left out.
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

/// Cuts the outline to every cell.
pub(crate) fn cut_to_cells(outline: &LoweredOutline, params: &CutParams) -> ShapeCurves {
    let [_, row_count] = params.size_cells;
    let mut by_row: Vec<Vec<Segment>> = vec![Vec::new(); row_count as usize];
    for segment in &outline.segments {
        // A segment goes to every row whose boxes it reaches; boxes overlap by two margins.
        let rows = params.cells_along(segment.start.y, segment.end.y, row_count);
        for row in rows {
            by_row[row as usize].push(segment.into());
        }
    }
    let mut shape = ShapeCurves::default();
    for (row, mut segments) in (0_u32..).zip(by_row) {
        // Stable, so that equal keys keep the order of the outline: the bytes must not depend on
        // the sort.
        segments.sort_by(|a, b| a.x_min().total_cmp(&b.x_min()));
        cut_row(&segments, row, params, &mut shape);
    }
    shape
}

/// Cuts one row. `segments` are those that reach into its boxes, sorted by their smallest x.
fn cut_row(segments: &[Segment], row: u32, params: &CutParams, shape: &mut ShapeCurves) {
    let low = segments.first().map_or(f64::INFINITY, Segment::x_min);
    let high = segments
        .iter()
        .fold(f64::NEG_INFINITY, |x, s| x.max(s.x_max()));
    let mut waiting = segments.iter().peekable();
    let mut active: Vec<&Segment> = Vec::new();
    // The sum of all segments to the left of all boxes to come.
    let mut passed = CellCurves::default();
    for column in params.cells_along(low, high, params.size_cells[0]) {
        let cell = params.box_of(column, row);
        let right = cell.origin.x + cell.size;
        // Strictly left of the right border: what only touches it is to the right.
        while let Some(segment) = waiting.next_if(|s| s.x_min() < right) {
            active.push(segment);
        }
        active.retain(|segment| {
            // Nothing to the left of this box can reach a later one.
            let keep = segment.x_max() > cell.origin.x;
            if !keep {
                passed.add(segment, &cell);
            }
            keep
        });
        let index = row * params.size_cells[0] + column;
        // Steps of everything to the left, then what is in the box.
        let mut curves = passed.clone();
        for segment in &active {
            curves.add(segment, &cell);
        }
        match curves.winding() {
            None => shape.edges.push((index, curves)),
            Some(0) => {}
            Some(winding) => shape.covered.push((index, winding)),
        }
    }
}

impl From<&lower::Segment> for Segment {
    fn from(segment: &lower::Segment) -> Self {
        let point = |p: kurbo::Point| Point::new(p.x, p.y);
        Self {
            start: point(segment.start),
            control: segment.control.map(point),
            end: point(segment.end),
            direction: segment.direction,
        }
    }
}
