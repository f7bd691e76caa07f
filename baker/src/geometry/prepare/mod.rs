//! Outlines made simple: after this, contours neither cross nor overlap and all run the same way
//! round, so that distances to them have a sign and every fill rule gives the same answer.
//!
//! Order of attempts: linesweeper, which keeps curves; `i_overlay`, which is robust and flattens; the
//! outline as drawn with its own fill rule. Each result is held against the drawing's winding
//! before it is taken, so what goes wrong here costs a distance field its precision, never the
//! picture its shape.

use kurbo::{
    Affine, BezPath, CubicBez, Line, ParamCurve, PathEl, PathSeg, Point, QuadBez, Shape as _,
};

use crate::{
    drawing::{FillRule, Shape},
    geometry::clamp_outline,
};

mod simplify;
#[cfg(test)]
mod tests;
mod verify;

use simplify::{Method, by_overlay, by_sweep};
use verify::agrees;

/// Longer side of the canvas in the units that simplification works in.
const SIMPLIFY_SIZE: f64 = 1024.0;
/// Segments beyond which a path is not simplified: crossings may grow with the square. Such a path
/// keeps its outline and its fill rule.
const MAX_SIMPLIFY_SEGMENTS: usize = 20_000;
/// Canvases from the origin beyond which a point is moved to this distance, in a way that changes
/// nothing nearer. Coordinates of curve lattices have room for 2^17.
const FARTHEST_CANVASES: f64 = 4096.0;

/// An outline ready for packing, cells and distance fields.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    /// Closed contours in canvas space.
    pub(crate) outline: BezPath,
    /// Inside test.
    pub(crate) rule: FillRule,
    /// What was done.
    pub(crate) note: Note,
}

/// What preparation did to a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Note {
    /// Nothing that shows.
    AsDrawn,
    /// Overlaps were removed.
    Simplified,
    /// The first method failed or disagreed, the second removed the overlaps.
    SecondMethod,
    /// No method agreed; the outline and its rule are as drawn.
    Failed,
}

/// Prepares `shape` on a canvas whose longer side is `canvas_longer` units.
pub(crate) fn prepare(shape: &Shape, canvas_longer: f64) -> Prepared {
    prepare_by(&[by_sweep, by_overlay], shape, canvas_longer)
}

/// As [`prepare`], by the first of `methods` that agrees with the drawing.
fn prepare_by(methods: &[Method], shape: &Shape, canvas_longer: f64) -> Prepared {
    let scale = SIMPLIFY_SIZE / canvas_longer;
    let drawn = clean(&shape.outline, canvas_longer);
    let scaled = Affine::scale(scale) * &drawn;
    let Some((index, simple)) = first_that_agrees(methods, &scaled, shape.fill_rule) else {
        return Prepared {
            outline: drawn,
            rule: shape.fill_rule,
            note: Note::Failed,
        };
    };
    // Overlaps change the signed area, so equal areas mean that there were none.
    let change = (simple.area().abs() - scaled.area().abs()).abs();
    let plain = change <= 1e-2 + 1e-6 * simple.area().abs();
    Prepared {
        outline: Affine::scale(1.0 / scale) * simple,
        rule: FillRule::NonZero,
        note: match (index, plain) {
            (0, true) => Note::AsDrawn,
            (0, false) => Note::Simplified,
            _ => Note::SecondMethod,
        },
    }
}

fn first_that_agrees(
    methods: &[Method],
    outline: &BezPath,
    rule: FillRule,
) -> Option<(usize, BezPath)> {
    if outline.elements().is_empty() {
        return Some((0, BezPath::new()));
    }
    if outline.elements().len() > MAX_SIMPLIFY_SEGMENTS {
        return None;
    }
    let results = methods.iter().enumerate();
    results
        .filter_map(|(index, method)| Some((index, clean_contours(&method(outline, rule)?))))
        .find(|(_, simple)| agrees(outline, rule, simple))
}

/// Closes every contour, moves what is absurdly far away nearer, and leaves out contours with a
/// non-finite point, empty segments and handles of no length. The canvas' longer side is
/// `canvas_longer` units.
pub(crate) fn clean(outline: &BezPath, canvas_longer: f64) -> BezPath {
    clamp_outline(&clean_contours(outline), FARTHEST_CANVASES * canvas_longer)
}

fn clean_contours(outline: &BezPath) -> BezPath {
    let mut cleaned = BezPath::new();
    for contour in contours(outline) {
        let segments: Vec<PathSeg> = contour.segments().filter_map(straighten).collect();
        let (Some(first), Some(last)) = (segments.first(), segments.last()) else {
            continue;
        };
        let (start, end) = (first.start(), last.end());
        if !contour.is_finite() {
            continue;
        }
        cleaned.move_to(start);
        cleaned.extend(segments.iter().map(PathSeg::as_path_el));
        if start != end {
            cleaned.line_to(start);
        }
        cleaned.close_path();
    }
    cleaned
}

fn contours(outline: &BezPath) -> Vec<BezPath> {
    let mut contours: Vec<BezPath> = Vec::new();
    let mut start = Point::ZERO;
    for element in outline.elements() {
        if let PathEl::MoveTo(p) = element {
            start = *p;
            contours.push(BezPath::new());
        }
        let Some(contour) = contours.last_mut() else {
            continue;
        };
        // After a closed contour the next goes on from its start (SVG 2 sec. 9.3.4).
        if matches!(contour.elements().last(), Some(PathEl::ClosePath)) {
            contours.push(BezPath::from_vec(vec![PathEl::MoveTo(start), *element]));
        } else {
            contour.push(*element);
        }
    }
    contours
}

/// The simplest segment with the same trace; `None` for a point.
fn straighten(segment: PathSeg) -> Option<PathSeg> {
    let simple = match segment {
        PathSeg::Quad(QuadBez { p0, p1, p2 }) if p1 == p0 || p1 == p2 => {
            PathSeg::Line(Line::new(p0, p2))
        }
        PathSeg::Cubic(CubicBez { p0, p1, p2, p3 }) if p1 == p0 && p2 == p3 => {
            PathSeg::Line(Line::new(p0, p3))
        }
        other => other,
    };
    match simple {
        PathSeg::Line(l) if l.p0 == l.p1 => None,
        PathSeg::Cubic(c) if c.p0 == c.p1 && c.p0 == c.p2 && c.p0 == c.p3 => None,
        other => Some(other),
    }
}
