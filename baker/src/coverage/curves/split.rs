//! Cells with more of an outline than a record holds: cut into strips, one record each.
//!
//! A strip's record is empty above and below it, so the union of the strips is the shape: exactly
//! so for points. A ramp of some footprint does not see edges of the strip next to its own.

use std::collections::BTreeMap;

use vtex_format::cut::{CellCurves, Segment};
use vtex_format::{MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS};

use super::CurveError;
use crate::drawing::FillRule;

/// Strips of one shape in one cell. More entries than this cost more than they show: with 2,047
/// lines each, some would lie within a hundredth of a pixel of each other at any zoom.
const MAX_STRIPS: usize = 64;
/// Largest base winding of a record, either way; a larger one becomes a step at the top.
const MAX_BASE: i32 = 511;

/// A part of a cell between two heights.
#[derive(Clone, Debug)]
struct Strip {
    top: f64,
    bottom: f64,
    /// Winding on the left edge at the top.
    winding: i32,
    /// Changes on the left edge strictly between top and bottom.
    steps: Vec<(f64, i32)>,
    /// All between top and bottom.
    segments: Vec<Segment>,
}

/// `cell` in as many parts as records need; most often itself. `size` is the side of the cell's box
/// in units.
///
/// # Errors
/// [`CurveError::Overflow`] when no cut of at most [`MAX_STRIPS`] strips helps.
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

    /// Whether it makes a record, with a step more at either end.
    fn fits(&self) -> bool {
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

    /// The same picture with smaller windings.
    fn reduced(mut self, rule: FillRule) -> Self {
        match rule {
            FillRule::EvenOdd => {
                self.winding = self.winding.rem_euclid(2);
                let steps = self.steps.into_iter();
                self.steps = steps
                    .filter(|step| step.1 % 2 != 0)
                    .map(|(y, _)| (y, 1))
                    .collect();
            }
            FillRule::NonZero => {
                let changes: i64 = self.steps.iter().map(|step| i64::from(step.1.abs())).sum();
                let most = changes + i64::try_from(self.segments.len()).unwrap_or(i64::MAX);
                // What cannot come to zero anywhere is inside everywhere.
                if i64::from(self.winding.abs()) > most {
                    self.winding = self.winding.signum();
                    self.steps.clear();
                    self.segments.clear();
                }
            }
        }
        self
    }

    /// Two strips of about as many segments each; `None` when that cannot help.
    fn halves(self) -> Option<[Self; 2]> {
        let through = |s: &&Segment| s.start.y <= self.top && s.end.y >= self.bottom;
        if self.segments.iter().filter(through).count() > MAX_CURVE_SEGMENTS as usize {
            return None;
        }
        let mut heights: Vec<f64> = self.segments.iter().map(|s| s.start.y).collect();
        heights.extend(self.steps.iter().map(|step| step.0));
        heights.retain(|&y| y > self.top && y < self.bottom);
        heights.sort_by(f64::total_cmp);
        let middle = (0.5 * (self.top + self.bottom)).floor();
        let height = heights.get(heights.len() / 2).copied().unwrap_or(middle);
        (height > self.top && height < self.bottom).then(|| self.cut_at(height))
    }

    fn cut_at(self, height: f64) -> [Self; 2] {
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
        let is_base = self.top <= 0.0 && self.winding.abs() <= MAX_BASE;
        let mut steps: BTreeMap<u16, i32> = self
            .steps
            .iter()
            .map(|&(y, change)| (height(y), change))
            .collect();
        if !is_base && self.winding != 0 {
            steps.insert(height(self.top), self.winding);
        }
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

/// A height of a box, which is an integer of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "boxes are at most 65535 units wide"
)]
fn height(y: f64) -> u16 {
    y as u16
}
