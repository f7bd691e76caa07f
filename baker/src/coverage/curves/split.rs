//! Splitting a cell with more segments than a record holds: into horizontal strips, one record
//! each.
//!
//! A strip's record is empty above and below the strip, so the union of all strips is the shape, and
//! a sample lies in one strip at most: lookups see no border between two strips.

use std::collections::BTreeMap;

use vtex_format::cut::{CellCurves, Segment};
use vtex_format::{MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS};

use super::CurveError;
use crate::drawing::FillRule;

/// Most strips of one shape in one cell. With 2,047 lines in each, a shape that needs more has
/// lines within a hundredth of a pixel of each other at any zoom: it is better off as an image.
const MAX_STRIPS: usize = 64;
/// Largest base winding that a record can hold, either way. A larger one becomes a step at the top.
const MAX_BASE: i32 = 511;

/// A part of a cell between two heights.
#[derive(Clone, Debug)]
struct Strip {
    top: f64,
    bottom: f64,
    /// Winding at the top of the left edge.
    winding: i32,
    /// Heights strictly between top and bottom at which the winding of the left edge changes, with
    /// the change.
    steps: Vec<(f64, i32)>,
    /// Segments, all between top and bottom.
    segments: Vec<Segment>,
}

/// The parts of `cell` that fit into a record each: itself, or strips. `size` is the side of the
/// cell's box in units.
///
/// # Errors
/// [`CurveError::Overflow`] when [`MAX_STRIPS`] strips are not enough.
pub(crate) fn split(
    cell: CellCurves,
    rule: FillRule,
    size: f64,
) -> Result<Vec<CellCurves>, CurveError> {
    if Strip::new(&cell, size).fits() && cell.base.abs() <= MAX_BASE {
        return Ok(vec![cell]);
    }
    let mut waiting = vec![Strip::new(&cell, size)];
    let mut parts = Vec::new();
    while let Some(strip) = waiting.pop() {
        let strip = strip.reduced(rule);
        if strip.fits() {
            parts.push(strip.into_cell(size));
        } else {
            let [upper, lower] = strip.halves().ok_or(CurveError::Overflow)?;
            // The upper one is taken first, so parts come out from top to bottom.
            waiting.extend([lower, upper]);
        }
        if parts.len() + waiting.len() > MAX_STRIPS {
            return Err(CurveError::Overflow);
        }
    }
    Ok(parts)
}

impl Strip {
    /// The whole cell.
    fn new(cell: &CellCurves, size: f64) -> Self {
        Self {
            top: 0.0,
            bottom: size,
            winding: cell.base,
            steps: cell
                .steps
                .iter()
                .map(|(&y, &change)| (f64::from(y), change))
                .collect(),
            segments: cell.segments.clone(),
        }
    }

    /// Whether it fits into a record, with one more step at either end.
    fn fits(&self) -> bool {
        // A record counts lines and quadratics apart, each with its own limit.
        let quads = self.segments.iter().filter(|s| s.control.is_some()).count();
        let lines = self.segments.len() - quads;
        let most = MAX_CURVE_SEGMENTS as usize;
        let fits_step = |change: i32| i16::try_from(change).is_ok();
        lines <= most
            && quads <= most
            && self.steps.len() + 2 <= MAX_CURVE_STEPS as usize
            && fits_step(self.winding)
            && fits_step(self.last_winding())
            && self.steps.iter().all(|&(_, change)| fits_step(change))
    }

    fn last_winding(&self) -> i32 {
        self.winding + self.steps.iter().map(|step| step.1).sum::<i32>()
    }

    /// The same inside with smaller windings and fewer steps.
    fn reduced(mut self, rule: FillRule) -> Self {
        match rule {
            FillRule::EvenOdd => {
                self.winding = self.winding.rem_euclid(2);
                // Only parity matters, so steps by an even number can go.
                let steps = self.steps.into_iter();
                self.steps = steps
                    .filter(|step| step.1 % 2 != 0)
                    .map(|(y, _)| (y, 1))
                    .collect();
            }
            FillRule::NonZero => {
                // No point can have a winding further than this from that at the top left.
                let changes: i64 = self.steps.iter().map(|step| i64::from(step.1.abs())).sum();
                let most = changes + i64::try_from(self.segments.len()).unwrap_or(i64::MAX);
                // Steps and segments together cannot bring the winding to zero: inside everywhere.
                if i64::from(self.winding.abs()) > most {
                    self.winding = self.winding.signum();
                    self.steps.clear();
                    self.segments.clear();
                }
            }
        }
        self
    }

    /// Two strips with about as many segments each; `None` when cutting cannot help, because too
    /// many segments run through from top to bottom or the strip is one unit high.
    fn halves(self) -> Option<[Self; 2]> {
        // A segment that spans the whole height stays in both halves: cutting cannot help if there
        // are too many.
        let through = |s: &&Segment| s.start.y <= self.top && s.end.y >= self.bottom;
        if self.segments.iter().filter(through).count() > MAX_CURVE_SEGMENTS as usize {
            return None;
        }
        // Cut at the median start, at an existing height: a cut there makes no new end points for
        // segments that begin at it.
        let mut heights: Vec<f64> = self.segments.iter().map(|s| s.start.y).collect();
        heights.extend(self.steps.iter().map(|step| step.0));
        heights.retain(|&y| y > self.top && y < self.bottom);
        heights.sort_by(f64::total_cmp);
        let middle = (0.5 * (self.top + self.bottom)).floor();
        let height = heights.get(heights.len() / 2).copied().unwrap_or(middle);
        (height > self.top && height < self.bottom).then(|| self.cut_at(height))
    }

    fn cut_at(self, height: f64) -> [Self; 2] {
        // A step at the cut belongs to neither half; it is part of the winding that the lower one
        // starts with.
        let before = |step: &&(f64, i32)| step.0 <= height;
        let change: i32 = self.steps.iter().filter(before).map(|step| step.1).sum();
        let mut upper = Self {
            bottom: height,
            steps: self
                .steps
                .iter()
                .filter(|s| s.0 < height)
                .copied()
                .collect(),
            segments: Vec::new(),
            ..self
        };
        let mut lower = Self {
            top: height,
            winding: self.winding + change,
            steps: self
                .steps
                .iter()
                .filter(|s| s.0 > height)
                .copied()
                .collect(),
            segments: Vec::new(),
            ..self
        };
        for segment in self.segments {
            if segment.end.y <= height {
                upper.segments.push(segment);
            } else if segment.start.y >= height {
                lower.segments.push(segment);
            } else {
                let [above, below] = segment.halves_at(height);
                upper.segments.push(above);
                lower.segments.push(below);
            }
        }
        [upper, lower]
    }

    fn into_cell(self, size: f64) -> CellCurves {
        let last = self.last_winding();
        // Only at the top of the box does the record have a base winding. Further down it starts at
        // 0 and gets a step.
        let is_base = self.top <= 0.0 && self.winding.abs() <= MAX_BASE;
        let mut steps: BTreeMap<u16, i32> = self
            .steps
            .iter()
            .map(|&(y, change)| (height(y), change))
            .collect();
        if !is_base && self.winding != 0 {
            steps.insert(height(self.top), self.winding);
        }
        // Below the strip the record must be empty again.
        if self.bottom < size && last != 0 {
            steps.insert(height(self.bottom), -last);
        }
        CellCurves {
            base: if is_base { self.winding } else { 0 },
            steps,
            segments: self.segments,
        }
    }
}

/// A height in a box as the record stores it: an integer of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "boxes are at most 65535 units wide"
)]
fn height(y: f64) -> u16 {
    y as u16
}
