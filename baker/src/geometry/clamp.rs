//! Moving far parts of an outline nearer, without a change of the picture.
//!
//! SVG allows coordinates far beyond any lattice of integers. What lies outside a large square only
//! matters through its winding inside the square, and clamping points to the square keeps that.

use kurbo::{BezPath, CubicBez, Line, ParamCurve, PathEl, PathSeg, Point, QuadBez, Rect};

use super::segment::control_box;

/// Pieces of a segment that cross the border and are smaller than this share of the square are not
/// cut further but replaced by a line: that far away the error does not show.
const SMALLEST_SHARE: f64 = 1.0 / 1024.0;
/// Most halvings of a segment. More cannot change a coordinate in f64.
const MAX_HALVINGS: u32 = 160;

/// The outline with contours closed and no point further than `farthest` from the origin along
/// either axis. Windings inside that square stay the same, and segments inside it stay
/// bit-identical.
pub(crate) fn clamp_outline(outline: &BezPath, farthest: f64) -> BezPath {
    let window = Rect::new(-farthest, -farthest, farthest, farthest);
    // The usual case: nothing is far away.
    if is_inside(outline.control_box(), window) {
        return outline.clone();
    }
    let mut clamped = BezPath::new();
    let mut here = None;
    for segment in outline.segments() {
        // A segment that does not continue the last one starts a contour.
        let start = clamp(segment.start(), window);
        if here != Some(start) {
            if here.is_some() {
                clamped.close_path();
            }
            clamped.move_to(start);
        }
        push(segment, window, MAX_HALVINGS, &mut clamped);
        here = Some(clamp(segment.end(), window));
    }
    if here.is_some() {
        clamped.close_path();
    }
    clamped
}

/// Appends `segment`, halving it until each piece lies inside the window, beside it, or is small.
/// A piece beside the window lies beyond one of its sides. Its ends are moved onto that side, so
/// the line between them winds around the same points inside.
fn push(segment: PathSeg, window: Rect, halvings: u32, clamped: &mut BezPath) {
    let area = control_box(&segment);
    if is_inside(area, window) {
        clamped.push(segment.as_path_el());
        return;
    }
    let beside = !area.overlaps(window);
    let small = area.width().max(area.height()) <= SMALLEST_SHARE * window.width();
    if beside || small || halvings == 0 {
        let end = clamp(segment.end(), window);
        // Several pieces in a row may be moved to one corner.
        if clamped.elements().last().and_then(PathEl::end_point) != Some(end) {
            clamped.line_to(end);
        }
        return;
    }
    let (first, second) = halves(segment);
    push(first, window, halvings - 1, clamped);
    push(second, window, halvings - 1, clamped);
}

/// Halves by means of points alone (de Casteljau at 1/2): ends stay bit-exact, and the near part of
/// a huge segment keeps its precision.
fn halves(segment: PathSeg) -> (PathSeg, PathSeg) {
    match segment {
        PathSeg::Line(l) => {
            let middle = l.p0.midpoint(l.p1);
            (
                Line::new(l.p0, middle).into(),
                Line::new(middle, l.p1).into(),
            )
        }
        PathSeg::Quad(q) => {
            let (a, b) = (q.p0.midpoint(q.p1), q.p1.midpoint(q.p2));
            let middle = a.midpoint(b);
            let first = QuadBez::new(q.p0, a, middle);
            (first.into(), QuadBez::new(middle, b, q.p2).into())
        }
        PathSeg::Cubic(c) => {
            let (a, b) = (c.p0.midpoint(c.p1), c.p2.midpoint(c.p3));
            let inner = c.p1.midpoint(c.p2);
            let (d, e) = (a.midpoint(inner), inner.midpoint(b));
            let middle = d.midpoint(e);
            let first = CubicBez::new(c.p0, a, d, middle);
            (first.into(), CubicBez::new(middle, e, b, c.p3).into())
        }
    }
}

fn is_inside(area: Rect, window: Rect) -> bool {
    area.x0 >= window.x0 && area.y0 >= window.y0 && area.x1 <= window.x1 && area.y1 <= window.y1
}

fn clamp(p: Point, window: Rect) -> Point {
    Point::new(
        p.x.clamp(window.x0, window.x1),
        p.y.clamp(window.y0, window.y1),
    )
}
