//! From outlines to what each record holds.

use std::collections::BTreeMap;

use super::left::Winding;
use super::{OutlineError, RecordParts, StoredOutline, StoredOutlines, StoredSegment};
use crate::curves::cut::{CellBox, Left, Point, Records, Segment, clip};
use crate::records::curve::{CurveLattice, MAX_CURVE_SEGMENTS};

/// What a clip costs beside a comparison of heights.
const CLIP_WORK: u64 = 16;
/// Most places at which cutting may look, weighted by what a look costs: about a second of one core.
/// Of hundreds of real drawings the one that needs most takes 98 million.
const MAX_WORK: u64 = 1 << 28;
/// What any file may take, and what more for each segment that it holds: no more than 790 of those
/// drawings. A few segments that meet thousands of records are refused soon.
const FREE_WORK: u64 = 1 << 20;
const SEGMENT_WORK: u64 = 1 << 12;

/// What cutting may take, in the measure of [`work`].
pub(super) fn budget(stored: &StoredOutlines) -> u64 {
    let outlines = stored.outlines.iter();
    let segments: u64 = outlines.map(|outline| outline.segments.len() as u64).sum();
    (FREE_WORK + SEGMENT_WORK * segments).min(MAX_WORK)
}

/// Cuts records, keeping for each outline its segments in the row of cells that was last asked for.
pub(super) struct Cutter<'a> {
    stored: &'a StoredOutlines,
    columns: u32,
    lattice: CurveLattice,
    rows: Vec<Option<Row>>,
    /// What may still be looked at.
    work_left: u64,
    /// What the present record holds. Its memory serves the next one again.
    left: Winding,
    segments: Vec<Segment>,
    records: Records,
}

/// An outline in a row of cells.
struct Row {
    row: u32,
    /// The last one that it was cut to.
    column: u32,
    /// What reaches into the row, by the smallest x.
    segments: Vec<Segment>,
    /// The first segment that lies right of the box.
    next: usize,
    /// Those before it that do not lie left of the box as a whole, in the same order.
    live: Vec<u32>,
    /// What the others leave of themselves: for all boxes further right the same.
    passed: Winding,
}

impl<'a> Cutter<'a> {
    pub(super) fn new(stored: &'a StoredOutlines, columns: u32, lattice: CurveLattice) -> Self {
        Self {
            stored,
            columns: columns.max(1),
            lattice,
            rows: stored.outlines.iter().map(|_| None).collect(),
            work_left: budget(stored),
            left: Winding::default(),
            segments: Vec::new(),
            records: Records::default(),
        }
    }

    /// Appends the words of one record, whose indices have been checked.
    pub(super) fn record(
        &mut self,
        record: &RecordParts,
        words: &mut Vec<u32>,
    ) -> Result<(), OutlineError> {
        let (column, row) = (record.cell % self.columns, record.cell / self.columns);
        let flatness = f64::from(self.stored.flatness_units);
        let cell = CellBox::of_cell([column, row], self.lattice, flatness);
        self.left.clear();
        self.segments.clear();
        let mut even_odd = false;
        for &outline in &record.outlines {
            self.cut(outline as usize, [column, row], &cell)?;
            // After each outline, so that memory stays bounded by the largest of them.
            if self.segments.len() > 2 * MAX_CURVE_SEGMENTS as usize {
                return Err(OutlineError::Overflow);
            }
            even_odd = self.stored.outlines[outline as usize].even_odd;
        }
        self.left.settle();
        let left = Left {
            base: self.left.base(),
            steps: self.left.steps().iter().copied(),
        };
        let record = self.records.append(left, &self.segments, even_odd, words);
        record.ok_or(OutlineError::Overflow)
    }

    fn cut(
        &mut self,
        index: usize,
        [column, row]: [u32; 2],
        cell: &CellBox,
    ) -> Result<(), OutlineError> {
        let outline = &self.stored.outlines[index];
        let mut work = 0;
        // Writers store records row by row, so one row for each outline is enough. Another order is
        // read as well; another row counts as more work.
        let known = match &mut self.rows[index] {
            Some(known) if known.row == row && known.column <= column => known,
            Some(known) if known.row == row => {
                known.rewind();
                known
            }
            known => {
                work += outline.segments.len() as u64;
                let known = known.get_or_insert_with(Row::new);
                known.fill(outline, cell);
                known
            }
        };
        (known.row, known.column) = (row, column);
        work += CLIP_WORK * known.segments.len() as u64;
        self.work_left = self.work_left.checked_sub(work).ok_or(OutlineError::Work)?;
        known.cut(cell, &mut self.left, &mut self.segments);
        Ok(())
    }
}

impl Row {
    fn new() -> Self {
        Self {
            row: 0,
            column: 0,
            segments: Vec::new(),
            next: 0,
            live: Vec::new(),
            passed: Winding::default(),
        }
    }

    /// Takes the segments that reach into a box's rows.
    fn fill(&mut self, outline: &StoredOutline, cell: &CellBox) {
        self.segments.clear();
        self.segments.extend(reaching(outline, cell).map(downward));
        let x_min = |segment: &Segment| segment.x_min();
        self.segments.sort_by(|a, b| x_min(a).total_cmp(&x_min(b)));
        self.rewind();
    }

    /// Begins again at the leftmost box.
    fn rewind(&mut self) {
        self.next = 0;
        self.live.clear();
        self.passed.clear();
    }

    /// Adds the parts in a box, which lies no further left than the one before, and what the parts left
    /// of it leave.
    fn cut(&mut self, cell: &CellBox, left: &mut Winding, inside: &mut Vec<Segment>) {
        let right = cell.origin.x + cell.size;
        while let Some(segment) = self.segments.get(self.next)
            && segment.x_min() < right
        {
            // Heads of files count segments in 32 bits.
            self.live.extend(u32::try_from(self.next));
            self.next += 1;
        }
        let (segments, passed) = (&self.segments, &mut self.passed);
        let mut add = |segment: &Segment, to: &mut Winding| {
            let clipped = clip(segment, cell);
            if let Some([top, bottom]) = clipped.left {
                to.change(top, segment.direction, cell.size);
                to.change(bottom, -segment.direction, cell.size);
            }
            inside.extend(clipped.inside);
        };
        self.live.retain(|&at| {
            let segment = &segments[at as usize];
            let stays = segment.x_max() > cell.origin.x;
            add(segment, if stays { &mut *left } else { &mut *passed });
            stays
        });
        passed.tidy();
        left.join(passed);
    }
}

/// What cutting takes when records come row by row, in the measure of [`budget`].
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
        let mut words = Vec::new();
        assert_eq!(cutter.record(&record(1), &mut words), Ok(()));
        let again = cutter.record(&record(1), &mut words);
        assert_eq!(again, Ok(()), "the row is known");
        let other = cutter.record(&record(2), &mut words);
        assert_eq!(other, Err(OutlineError::Work));
    }
}
