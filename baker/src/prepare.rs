//! Outlines made simple: after this, contours neither cross nor overlap and all run the same way
//! round, so that distances to them have a sign and every fill rule gives the same answer.

use std::panic::{AssertUnwindSafe, catch_unwind};

use kurbo::{Affine, BezPath, CubicBez, Line, PathEl, PathSeg, Point, QuadBez, Shape as _};
use linesweeper::topology::Topology;

use crate::{
    drawing::{FillRule, Shape},
    geometry::{Region, flatten, line_line_distance},
};

/// Longer side of the canvas in the units that simplification works in.
const SIMPLIFY_SIZE: f64 = 1024.0;
/// How far simplification may move an edge, in those units. Measured: smaller values cost time and
/// bring slivers, larger ones show at 64x.
const SIMPLIFY_EPS: f64 = 1e-4;
/// Segments beyond which a path is not simplified: crossings may grow with the square. Such a path
/// keeps its outline and its fill rule.
const MAX_SIMPLIFY_SEGMENTS: usize = 20_000;
/// Points at which a simplified outline must agree with the original.
const CHECK_POINTS: u32 = 64;

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
    Plain,
    /// Overlaps were removed.
    Simplified,
    /// Simplification failed or disagreed; the outline is as drawn.
    Fallback,
}

impl Note {
    /// As recorded in the file.
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::Plain => "",
            Self::Simplified => "simplified",
            Self::Fallback => "fallback",
        }
    }
}

/// Prepares `shape` on a canvas whose longer side is `canvas_longer` units.
pub(crate) fn prepare(shape: &Shape, canvas_longer: f64) -> Prepared {
    let scale = SIMPLIFY_SIZE / canvas_longer;
    let mut outline = clean(&shape.outline);
    outline.apply_affine(Affine::scale(scale));
    let (mut outline, rule, note) = match simplify(&outline, shape.fill_rule) {
        Some(simple) => {
            // Overlaps change the signed area, so equal areas mean that there were none.
            let change = (simple.area().abs() - outline.area().abs()).abs();
            let plain = change <= 1e-2 + 1e-6 * simple.area().abs();
            let note = if plain { Note::Plain } else { Note::Simplified };
            (simple, FillRule::NonZero, note)
        }
        None => (outline, shape.fill_rule, Note::Fallback),
    };
    outline.apply_affine(Affine::scale(1.0 / scale));
    Prepared {
        outline,
        rule,
        note,
    }
}

/// Closes every contour and leaves out contours with a non-finite point, empty segments and
/// handles of no length.
fn clean(outline: &BezPath) -> BezPath {
    let mut cleaned = BezPath::new();
    for contour in contours(outline) {
        let segments: Vec<PathSeg> = contour.segments().filter_map(straighten).collect();
        let (Some(first), Some(last)) = (segments.first(), segments.last()) else {
            continue;
        };
        let (start, end) = (start_of(first), end_of(last));
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
    for element in outline.elements() {
        if matches!(element, PathEl::MoveTo(_)) || contours.is_empty() {
            contours.push(BezPath::new());
        }
        if let Some(contour) = contours.last_mut() {
            let started = !contour.elements().is_empty();
            if started || matches!(element, PathEl::MoveTo(_)) {
                contour.push(*element);
            }
        }
    }
    contours
}

fn start_of(segment: &PathSeg) -> Point {
    kurbo::ParamCurve::start(segment)
}

fn end_of(segment: &PathSeg) -> Point {
    kurbo::ParamCurve::end(segment)
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

/// The boundary of the filled region; `None` when that cannot be had.
fn simplify(outline: &BezPath, rule: FillRule) -> Option<BezPath> {
    if outline.elements().is_empty() {
        return Some(BezPath::new());
    }
    if outline.elements().len() > MAX_SIMPLIFY_SEGMENTS {
        return None;
    }
    // linesweeper is exact in intent but young: a panic costs one shape its simplification.
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
    let simple = clean(&simple);
    agrees(outline, rule, &simple).then_some(simple)
}

/// Whether both outlines fill the same of [`CHECK_POINTS`] points, those on an edge aside.
fn agrees(outline: &BezPath, rule: FillRule, simple: &BezPath) -> bool {
    let before = Region::new(outline, rule);
    let after = Region::new(simple, FillRule::NonZero);
    let area = before.bounds();
    let mut points = PointSequence::default();
    (0..CHECK_POINTS).all(|_| {
        let [u, v] = points.next();
        let p = Point::new(area.x0 + u * area.width(), area.y0 + v * area.height());
        before.contains(p) == after.contains(p) || near_edge(outline, p)
    })
}

fn near_edge(outline: &BezPath, p: Point) -> bool {
    let point = Line::new(p, p);
    flatten(outline, SIMPLIFY_EPS).iter().any(|contour| {
        contour.windows(2).any(|ends| {
            line_line_distance(Line::new(ends[0], ends[1]), point) < 10.0 * SIMPLIFY_EPS
        })
    })
}

/// The additive recurrence R2 of Roberts (2018): evenly spread, the same every time.
#[derive(Debug, Default)]
struct PointSequence {
    index: f64,
}

impl PointSequence {
    fn next(&mut self) -> [f64; 2] {
        self.index += 1.0;
        [
            (0.754_877_666_246_692_8 * self.index).fract(),
            (0.569_840_290_998_053_3 * self.index).fract(),
        ]
    }
}
