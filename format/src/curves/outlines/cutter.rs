//! From outlines to what each record holds.

use std::collections::BTreeMap;

use super::{MAX_WORK, OutlineError, RecordParts, StoredOutline, StoredOutlines, StoredSegment};
use crate::curves::cut::{CellBox, CellCurves, Point, Segment};
use crate::records::curve::CurveLattice;

/// What a clip costs beside a comparison of heights.
const CLIP_WORK: u64 = 16;

/// Cuts records, keeping for each outline its segments in the row of cells that was last asked for.
pub(super) struct Cutter<'a> {
    stored: &'a StoredOutlines,
    columns: u32,
    lattice: CurveLattice,
    rows: Vec<Option<(u32, Vec<Segment>)>>,
    /// What may still be looked at.
    work_left: u64,
}

impl<'a> Cutter<'a> {
    pub(super) fn new(stored: &'a StoredOutlines, columns: u32, lattice: CurveLattice) -> Self {
        Self {
            stored,
            columns: columns.max(1),
            lattice,
            rows: vec![None; stored.outlines.len()],
            work_left: MAX_WORK,
        }
    }

    /// The words of one record, whose indices have been checked.
    pub(super) fn record(&mut self, record: &RecordParts) -> Result<Vec<u32>, OutlineError> {
        let (column, row) = (record.cell % self.columns, record.cell / self.columns);
        let flatness = f64::from(self.stored.flatness_units);
        let cell = CellBox::of_cell([column, row], self.lattice, flatness);
        let mut curves = CellCurves::default();
        let mut even_odd = false;
        for &outline in &record.outlines {
            self.cut(outline as usize, row, &cell, &mut curves)?;
            // After each outline, so that memory stays bounded by the largest of them.
            if curves.is_too_much() {
                return Err(OutlineError::Overflow);
            }
            even_odd = self.stored.outlines[outline as usize].even_odd;
        }
        curves.record(even_odd).ok_or(OutlineError::Overflow)
    }

    fn cut(
        &mut self,
        index: usize,
        row: u32,
        cell: &CellBox,
        curves: &mut CellCurves,
    ) -> Result<(), OutlineError> {
        let outline = &self.stored.outlines[index];
        let known = &mut self.rows[index];
        let mut work = 0;
        // Writers store records row by row, so one row for each outline is enough. Another order is
        // read as well and counts as more work.
        if known.as_ref().is_none_or(|(known, _)| *known != row) {
            work += outline.segments.len() as u64;
            *known = Some((row, row_segments(outline, cell)));
        }
        let segments = known.as_ref().map_or(&[][..], |(_, segments)| segments);
        work += CLIP_WORK * segments.len() as u64;
        self.work_left = self.work_left.checked_sub(work).ok_or(OutlineError::Work)?;
        let right = cell.origin.x + cell.size;
        // In order of their smallest x: those from here on lie right of the box.
        for segment in segments.iter().take_while(|s| s.x_min() < right) {
            curves.add(segment, cell);
        }
        Ok(())
    }
}

/// What cutting takes when records come row by row, in the measure of [`MAX_WORK`].
pub(super) fn work(stored: &StoredOutlines, columns: u32, lattice: CurveLattice) -> u64 {
    let mut cells: BTreeMap<(u32, u32), u64> = BTreeMap::new();
    for record in &stored.records {
        let row = record.cell / columns.max(1);
        for &outline in &record.outlines {
            *cells.entry((outline, row)).or_default() += 1;
        }
    }
    let work = cells.into_iter().map(|((outline, row), cells)| {
        let Some(outline) = stored.outlines.get(outline as usize) else {
            return 0;
        };
        let cell = CellBox::of_cell([0, row], lattice, 0.0);
        let reaching = reaching(outline, &cell).count() as u64;
        outline.segments.len() as u64 + CLIP_WORK * cells * reaching
    });
    work.fold(0, u64::saturating_add)
}

/// The segments of which more than an end lies in the box's rows.
fn reaching<'a>(
    outline: &'a StoredOutline,
    cell: &CellBox,
) -> impl Iterator<Item = &'a StoredSegment> {
    let (top, bottom) = (cell.origin.y, cell.origin.y + cell.size);
    outline.segments.iter().filter(move |segment| {
        let [a, b] = [segment.from[1], segment.to[1]].map(f64::from);
        a.max(b) > top && a.min(b) < bottom
    })
}

/// Those segments by their smallest x.
fn row_segments(outline: &StoredOutline, cell: &CellBox) -> Vec<Segment> {
    let mut row: Vec<Segment> = reaching(outline, cell).map(downward).collect();
    row.sort_by(|a, b| a.x_min().total_cmp(&b.x_min()));
    row
}

/// From the upper to the lower end.
fn downward(segment: &StoredSegment) -> Segment {
    let [from, to] = [segment.from, segment.to];
    // By height, then from left to right: level segments have an upper end too.
    let down = (from[1], from[0]) < (to[1], to[0]);
    let (start, end) = if down { (from, to) } else { (to, from) };
    Segment {
        start: Point::of(start),
        control: segment.control.map(Point::of),
        end: Point::of(end),
        direction: if down { 1 } else { -1 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_bounded() {
        let corners = [[0, 0], [300, 9_000], [600, 0]];
        let segment = |i: usize| StoredSegment {
            from: corners[i],
            control: None,
            to: corners[(i + 1) % 3],
        };
        let stored = StoredOutlines {
            outlines: vec![StoredOutline {
                even_odd: false,
                segments: (0..3).map(segment).collect(),
            }],
            ..StoredOutlines::default()
        };
        let lattice = CurveLattice {
            units_per_cell: 1_000,
            margin_units: 0,
        };
        let record = |row: u32| RecordParts {
            cell: 2 * row,
            outlines: vec![0],
        };
        // Two of the three segments reach into row 1: 3 to find them, 32 to clip them.
        let mut cutter = Cutter::new(&stored, 2, lattice);
        cutter.work_left = 3 + 32 + 32;
        let both = StoredOutlines {
            records: vec![record(1), record(1)],
            ..stored.clone()
        };
        assert_eq!(work(&both, 2, lattice), cutter.work_left);
        assert!(cutter.record(&record(1)).is_ok());
        assert!(cutter.record(&record(1)).is_ok(), "the row is known");
        assert_eq!(cutter.record(&record(2)), Err(OutlineError::Work));
    }
}
