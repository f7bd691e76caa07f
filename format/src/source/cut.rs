//! From outlines to what each record holds.

use std::collections::BTreeMap;

use super::clip::{CellBox, Point, Segment, clip};
use super::record::{to_u16, words};
use super::{CurveSources, MAX_WORK, SourceError, SourceOutline, SourceRecord, SourceSegment};
use crate::{CurveLattice, MAX_CURVE_SEGMENTS};

/// What a clip costs beside a comparison of heights.
const CLIP_WORK: u64 = 16;

/// Shapes inside one cell's box, in units from the box's top left corner.
#[derive(Clone, Debug, Default)]
pub(super) struct CellCurves {
    /// Winding at the box's top left corner.
    pub(super) base: i32,
    /// Heights on the box's left edge to the change of the winding there, none of them zero: where
    /// a contour goes on left of the box its segments' ends cancel.
    pub(super) steps: BTreeMap<u16, i32>,
    /// What of the outlines lies in the box.
    pub(super) segments: Vec<Segment>,
}

/// Cuts records, keeping for each outline its segments in the row of cells that was last asked for.
pub(super) struct Cutter<'a> {
    sources: &'a CurveSources,
    columns: u32,
    lattice: CurveLattice,
    rows: Vec<Option<(u32, Vec<Segment>)>>,
    work: u64,
}

impl<'a> Cutter<'a> {
    pub(super) fn new(sources: &'a CurveSources, columns: u32, lattice: CurveLattice) -> Self {
        Self {
            sources,
            columns: columns.max(1),
            lattice,
            rows: vec![None; sources.outlines.len()],
            work: 0,
        }
    }

    /// The words of one record, whose indices have been checked.
    pub(super) fn record(&mut self, record: &SourceRecord) -> Result<Vec<u32>, SourceError> {
        let (column, row) = (record.cell % self.columns, record.cell / self.columns);
        let cell = self.box_of(column, row);
        let mut curves = CellCurves::default();
        let mut even_odd = false;
        for &outline in &record.outlines {
            self.cut(outline as usize, row, &cell, &mut curves)?;
            if curves.segments.len() > 2 * MAX_CURVE_SEGMENTS as usize {
                return Err(SourceError::Overflow);
            }
            even_odd = self.sources.outlines[outline as usize].even_odd;
        }
        words(&curves, even_odd).ok_or(SourceError::Overflow)
    }

    fn box_of(&self, column: u32, row: u32) -> CellBox {
        let (side, margin) = (self.lattice.units_per_cell, self.lattice.margin_units);
        let corner = |index: u32| f64::from(index) * f64::from(side) - f64::from(margin);
        CellBox {
            origin: Point::new(corner(column), corner(row)),
            size: f64::from(self.lattice.box_units()),
            flatness: f64::from(self.sources.flatness_units),
        }
    }

    fn cut(
        &mut self,
        index: usize,
        row: u32,
        cell: &CellBox,
        curves: &mut CellCurves,
    ) -> Result<(), SourceError> {
        let outline = &self.sources.outlines[index];
        let known = &mut self.rows[index];
        if known.as_ref().is_none_or(|(known, _)| *known != row) {
            self.work += outline.segments.len() as u64;
            *known = Some((row, row_segments(outline, cell)));
        }
        let segments = known.as_ref().map_or(&[][..], |(_, segments)| segments);
        self.work += CLIP_WORK * segments.len() as u64;
        if self.work > MAX_WORK {
            return Err(SourceError::Work);
        }
        curves.add(segments, cell);
        Ok(())
    }
}

/// The segments of which more than an end lies in the box's rows, by their smallest x.
fn row_segments(outline: &SourceOutline, cell: &CellBox) -> Vec<Segment> {
    let (top, bottom) = (cell.origin.y, cell.origin.y + cell.size);
    let all = outline.segments.iter().map(downward);
    let mut row: Vec<Segment> = all
        .filter(|segment| segment.end.y > top && segment.start.y < bottom)
        .collect();
    row.sort_by(|a, b| a.x_min().total_cmp(&b.x_min()));
    row
}

/// From the upper to the lower end.
fn downward(segment: &SourceSegment) -> Segment {
    let [from, to] = [segment.from, segment.to];
    let down = (from[1], from[0]) < (to[1], to[0]);
    let (start, end) = if down { (from, to) } else { (to, from) };
    Segment {
        start: Point::of(start),
        control: segment.control.map(Point::of),
        end: Point::of(end),
        direction: if down { 1 } else { -1 },
    }
}

impl CellCurves {
    /// Adds what segments are to the box.
    fn add(&mut self, row: &[Segment], cell: &CellBox) {
        for segment in row {
            let clipped = clip(segment, cell);
            if let Some([top, bottom]) = clipped.left {
                self.change(top, segment.direction, cell.size);
                self.change(bottom, -segment.direction, cell.size);
            }
            self.segments.extend(clipped.inside);
        }
    }

    fn change(&mut self, height: f64, change: i32, size: f64) {
        if height <= 0.0 {
            self.base = self.base.saturating_add(change);
        } else if height < size {
            let sum = self.steps.entry(to_u16(height)).or_default();
            *sum = sum.saturating_add(change);
            if *sum == 0 {
                self.steps.remove(&to_u16(height));
            }
        }
    }
}
