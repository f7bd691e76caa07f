//! Preparing outlines for MSDFs: overlaps are removed.
//!
//! An MSDF needs contours that neither cross nor overlap and whose insides all lie on the same
//! side. Then the distance to the nearest edge has the right sign, and every fill rule gives the
//! same answer. Curves need none of this: they test windings.
//!
//! Three attempts, in this order: linesweeper, which keeps curves; `i_overlay`, which is robust but
//! flattens; the outline as drawn, with its own fill rule. Each result is compared with the winding
//! of the drawing before it is used. So a fault of a library can make an MSDF less precise, but it
//! cannot change the shape.

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

/// Longer side of the canvas in the units that simplification works in. linesweeper takes its
/// tolerance as an absolute number, so the size of coordinates decides its precision.
const SIMPLIFY_SIZE: f64 = 1024.0;
/// Segments of the largest path that is simplified, because the number of crossings can grow with
/// the square. A path with more keeps its outline and its fill rule.
const MAX_SIMPLIFY_SEGMENTS: usize = 20_000;
/// Points further from the origin than this many canvases are moved to this distance, which changes
/// nothing nearer. Coordinates of curve lattices could hold 2^17 canvases.
const FARTHEST_CANVASES: f64 = 4096.0;

/// An outline that is ready for an MSDF.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    /// Closed contours in canvas space.
    pub(crate) outline: BezPath,
    /// Its fill rule.
    pub(crate) rule: FillRule,
    /// What preparation did.
    pub(crate) note: Note,
}

/// What preparation did to a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Note {
    /// No overlaps were found.
    AsDrawn,
    /// Overlaps were removed.
    Simplified,
    /// The first method failed or disagreed with the drawing; the second removed the overlaps.
    SecondMethod,
    /// No method agreed with the drawing. Outline and fill rule are as drawn.
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
    // Removing an overlap changes the signed area. So equal areas mean that there was none.
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
    // An empty outline needs no method.
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

/// The outline with contours closed and far points moved nearer, without segments of no length,
/// handles of no length, and contours with a non-finite point. The canvas' longer side is
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
        // Dropping segments of no length leaves no gap: their ends coincide.
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

/// One path for each contour.
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

/// The simplest segment with the same points; `None` if that is a single point.
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
