//! Two methods to find the boundary of what an outline fills.

use std::panic::{AssertUnwindSafe, catch_unwind};

use i_overlay::{core::fill_rule, float::simplify::SimplifyShape};
use kurbo::{BezPath, Point};
use linesweeper::topology::Topology;

use crate::{drawing::FillRule, geometry::flatten};

/// How far a simplification may move an edge, in units of a 1024th of the canvas. Measured: smaller
/// values take longer and leave slivers; larger ones can be seen at zoom 64.
pub(super) const SIMPLIFY_EPS: f64 = 1e-4;
/// How far flattening for the second method may move an edge, in the same units: a tenth of what
/// one byte of distance resolves on a lattice of 1024 texels.
const FLATTEN_EPS: f64 = 1e-3;

/// The boundary of what an outline fills by a rule; `None` on failure.
pub(super) type Method = fn(&BezPath, FillRule) -> Option<BezPath>;

/// By linesweeper, which keeps curves.
pub(super) fn by_sweep(outline: &BezPath, rule: FillRule) -> Option<BezPath> {
    // The library is young. A panic in it is a failure of this method for one shape.
    let contours = catch_unwind(AssertUnwindSafe(|| {
        Topology::<i32>::from_path(outline, SIMPLIFY_EPS)
            .ok()
            .map(|topology| topology.contours(|winding| rule.fills(*winding)))
    }))
    .ok()??;
    let mut simple = BezPath::new();
    for contour in contours.contours() {
        simple.extend(contour.path.elements().iter().copied());
    }
    Some(simple)
}

/// By `i_overlay`, which is exact on integers. The outline is flattened first.
pub(super) fn by_overlay(outline: &BezPath, rule: FillRule) -> Option<BezPath> {
    let contours: Vec<Vec<[f64; 2]>> = flatten(outline, FLATTEN_EPS)
        .into_iter()
        .map(|contour| contour.into_iter().map(|p| [p.x, p.y]).collect())
        .collect();
    let rule = match rule {
        FillRule::NonZero => fill_rule::FillRule::NonZero,
        FillRule::EvenOdd => fill_rule::FillRule::EvenOdd,
    };
    let shapes = catch_unwind(AssertUnwindSafe(|| contours.simplify_shape_as::<i64>(rule))).ok()?;
    let mut simple = BezPath::new();
    for contour in shapes.iter().flatten() {
        // `i_overlay` gives points without the closing one.
        let mut points = contour.iter().map(|&[x, y]| Point::new(x, y));
        let Some(first) = points.next() else { continue };
        simple.move_to(first);
        points.for_each(|p| simple.line_to(p));
        simple.close_path();
    }
    Some(simple)
}
