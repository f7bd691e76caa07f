//! Single segments of outlines.

use kurbo::{ParamCurve, ParamCurveDeriv, PathSeg, Point, Rect, Vec2};

/// Box of the control points.
pub(crate) fn control_box(segment: &PathSeg) -> Rect {
    match segment {
        PathSeg::Line(l) => Rect::from_points(l.p0, l.p1),
        PathSeg::Quad(q) => Rect::from_points(q.p0, q.p2).union_pt(q.p1),
        PathSeg::Cubic(c) => Rect::from_points(c.p0, c.p3).union_pt(c.p1).union_pt(c.p2),
    }
}

/// Direction of travel at a parameter, of any length; zero where control points coincide.
pub(crate) fn tangent(segment: &PathSeg, t: f64) -> Vec2 {
    match segment {
        PathSeg::Line(line) => line.p1 - line.p0,
        PathSeg::Quad(quad) => quad.deriv().eval(t).to_vec2(),
        PathSeg::Cubic(cubic) => cubic.deriv().eval(t).to_vec2(),
    }
}

/// Moves the start; other control points stay.
pub(crate) fn set_start(segment: &mut PathSeg, p: Point) {
    match segment {
        PathSeg::Line(l) => l.p0 = p,
        PathSeg::Quad(q) => q.p0 = p,
        PathSeg::Cubic(c) => c.p0 = p,
    }
}

/// Moves the end; other control points stay.
pub(crate) fn set_end(segment: &mut PathSeg, p: Point) {
    match segment {
        PathSeg::Line(l) => l.p1 = p,
        PathSeg::Quad(q) => q.p2 = p,
        PathSeg::Cubic(c) => c.p3 = p,
    }
}
