//! What curve records are made from: outlines, each stored once, and which of them meet in which
//! cell. Cutting is exact, so a file needs no records, however fine its grid: `docs/format.md`
//! section 2.14.

mod bits;
mod cutter;
mod left;
pub(crate) mod stream;

use crate::records::curve::CurveLattice;
use crate::records::meta::Grid;
use cutter::Cutter;

/// Outlines and where they are cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StoredOutlines {
    /// A quadratic whose part in a cell stays within this many units of its chord becomes a line.
    pub flatness_units: f32,
    /// The outlines.
    pub outlines: Vec<StoredOutline>,
    /// One a curve record, in the records' order.
    pub records: Vec<RecordParts>,
}

/// The outline of one shape.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StoredOutline {
    /// Inside where the winding is odd instead of not zero.
    pub even_odd: bool,
    /// Its contours one after the other, each along its own direction. Contours are closed.
    pub segments: Vec<StoredSegment>,
}

/// A line or quadratic on the lattice of all cells: in units, origin at the corner of cell (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredSegment {
    /// First end along the contour.
    pub from: [i32; 2],
    /// Control point of a quadratic, inside the box of the ends: both coordinates are monotone.
    pub control: Option<[i32; 2]>,
    /// Last end.
    pub to: [i32; 2],
}

impl StoredSegment {
    /// Whether the control point lies in the box of the ends.
    fn is_monotone(&self) -> bool {
        self.control.is_none_or(|control| {
            [0, 1].iter().all(|&axis| {
                let (a, b) = (self.from[axis], self.to[axis]);
                (a.min(b)..=a.max(b)).contains(&control[axis])
            })
        })
    }
}

/// What one record is cut from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RecordParts {
    /// Index of the cell.
    pub cell: u32,
    /// Indices of the outlines; all of one fill rule, and their windings may be added.
    pub outlines: Vec<u32>,
}

impl StoredOutlines {
    /// The words of all records, one record after the other.
    ///
    /// # Errors
    /// [`OutlineError`] when no records can be made from them.
    pub fn records(&self, grid: &Grid, lattice: CurveLattice) -> Result<Vec<u32>, OutlineError> {
        self.records_within(grid, lattice, u64::MAX)
    }

    /// Whether readers take the time to cut them; where not, a file must hold the records.
    pub fn is_cuttable(&self, grid: &Grid, lattice: CurveLattice) -> bool {
        cutter::work(self, grid.size_cells[0], lattice) <= cutter::budget(self)
    }

    /// As [`StoredOutlines::records`], giving up beyond `max_words`.
    pub(crate) fn records_within(
        &self,
        grid: &Grid,
        lattice: CurveLattice,
        max_words: u64,
    ) -> Result<Vec<u32>, OutlineError> {
        self.check(grid)?;
        let mut cutter = Cutter::new(self, grid.size_cells[0], lattice);
        let mut words = Vec::new();
        for record in &self.records {
            cutter.record(record, &mut words)?;
            if words.len() as u64 > max_words {
                return Err(OutlineError::Length);
            }
        }
        Ok(words)
    }

    /// Every index names something and quadratics are monotone.
    fn check(&self, grid: &Grid) -> Result<(), OutlineError> {
        let [columns, rows] = grid.size_cells.map(u64::from);
        let names = |record: &RecordParts| {
            let mut outlines = record.outlines.iter();
            u64::from(record.cell) < columns * rows
                && outlines.all(|&outline| (outline as usize) < self.outlines.len())
        };
        if !self.records.iter().all(names) {
            return Err(OutlineError::Index);
        }
        if self
            .outlines
            .iter()
            .any(|outline| outline.segments.is_empty())
        {
            return Err(OutlineError::Index);
        }
        let mut segments = self.outlines.iter().flat_map(|outline| &outline.segments);
        if !segments.all(StoredSegment::is_monotone) {
            return Err(OutlineError::Control);
        }
        Ok(())
    }
}

/// Why no records can be made from outlines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// The section's bytes have no meaning.
    #[error("the bytes of the outlines have no meaning")]
    Stream,
    /// A record names a cell or an outline that does not exist, or an outline has no segments.
    #[error("a record names what does not exist, or an outline is empty")]
    Index,
    /// A control point lies outside the box of its ends.
    #[error("a quadratic is not monotone")]
    Control,
    /// A cell holds more segments or steps, or a larger winding, than a record can.
    #[error("a record is too large")]
    Overflow,
    /// The records are more words than they should be.
    #[error("the records have another length")]
    Length,
    /// Cutting would take too long.
    #[error("cutting the outlines takes more work than the format grants")]
    Work,
}
