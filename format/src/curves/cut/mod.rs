//! Cutting outlines to a cell's box: what bakers and readers do alike, to the last bit. The
//! arithmetic is that of `docs/format.md` section 2.14.
//!
//! Invariant: watertight. A point that two segments share is rounded once, the cut at a box's left
//! edge gives one y to the segment inside and to the step outside, and all comparisons of y are
//! half open. So on every height the crossings add up.

mod clip;
mod record;

use std::collections::BTreeMap;

use crate::records::curve::CurveLattice;

pub(crate) use clip::clip;
pub use clip::{Point, Segment, parameter};
pub(crate) use record::{Left, Records, to_u16};

/// A cell's box in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellBox {
    /// Top left corner.
    pub origin: Point,
    /// Side.
    pub size: f64,
    /// A quadratic that stays within this of its chord becomes a line.
    pub flatness: f64,
}

impl CellBox {
    /// The box of a cell, given by column and row.
    pub fn of_cell(cell: [u32; 2], lattice: CurveLattice, flatness_units: f64) -> Self {
        let (side, margin) = (lattice.units_per_cell, lattice.margin_units);
        let corner = |index: u32| f64::from(index) * f64::from(side) - f64::from(margin);
        Self {
            origin: Point::new(corner(cell[0]), corner(cell[1])),
            size: f64::from(lattice.box_units()),
            flatness: flatness_units,
        }
    }
}

/// Shapes inside one cell's box, in units from the box's top left corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellCurves {
    /// Winding at the box's top left corner.
    pub base: i32,
    /// Heights on the box's left edge to the change of the winding there, none of them zero: where
    /// a contour goes on left of the box its segments' ends cancel.
    pub steps: BTreeMap<u16, i32>,
    /// The parts of the outlines that lie in the box.
    pub segments: Vec<Segment>,
}

impl CellCurves {
    /// Adds a segment: the part in the box as it is, the part left of it as steps. More of the
    /// segment than an end must lie in the rows of the box.
    pub fn add(&mut self, segment: &Segment, cell: &CellBox) {
        let clipped = clip(segment, cell);
        if let Some([top, bottom]) = clipped.left {
            self.change(top, segment.direction, cell.size);
            self.change(bottom, -segment.direction, cell.size);
        }
        self.segments.extend(clipped.inside);
    }

    /// Adds other shapes in the same box; windings add up.
    pub fn join(&mut self, other: &Self) {
        // A sum that saturates fits no record, which `record` says.
        self.base = self.base.saturating_add(other.base);
        for (&height, &change) in &other.steps {
            self.step(height, change);
        }
        self.segments.extend(&other.segments);
    }

    /// The winding of the whole box; `None` when there is some outline in it or left of it.
    pub fn winding(&self) -> Option<i32> {
        (self.segments.is_empty() && self.steps.is_empty()).then_some(self.base)
    }

    /// The words of the record; `None` when they do not fit one.
    pub fn record(&self, even_odd: bool) -> Option<Vec<u32>> {
        let left = Left {
            base: self.base,
            steps: self.steps.iter().map(|(&height, &change)| (height, change)),
        };
        let mut words = Vec::new();
        let fits = Records::default().append(left, &self.segments, even_odd, &mut words);
        fits.map(|()| words)
    }

    fn change(&mut self, height: f64, change: i32, size: f64) {
        // A change at or above the top holds for the whole box, one at or below the bottom for none
        // of it. A step counts from its own height on.
        if height <= 0.0 {
            self.base = self.base.saturating_add(change);
        } else if height < size {
            self.step(to_u16(height), change);
        }
    }

    fn step(&mut self, height: u16, change: i32) {
        let sum = self.steps.entry(height).or_default();
        *sum = sum.saturating_add(change);
        if *sum == 0 {
            self.steps.remove(&height);
        }
    }
}
