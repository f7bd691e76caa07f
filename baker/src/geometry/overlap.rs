//! Distances between straight lines and boxes.

use kurbo::{Line, Point, Rect, Vec2};

use super::clip_line;

/// Distance between two line segments, 0 where they touch.
pub(crate) fn line_line_distance(a: Line, b: Line) -> f64 {
    if cross(a, b) {
        return 0.0;
    }
    point_line_distance(a.p0, b)
        .min(point_line_distance(a.p1, b))
        .min(point_line_distance(b.p0, a))
        .min(point_line_distance(b.p1, a))
}

/// Distance between a line segment and a filled box, 0 where they touch.
pub(crate) fn line_box_distance(line: Line, area: Rect) -> f64 {
    if clip_line(line, area).is_some() {
        return 0.0;
    }
    let corners = [
        Point::new(area.x0, area.y0),
        Point::new(area.x1, area.y0),
        Point::new(area.x1, area.y1),
        Point::new(area.x0, area.y1),
    ];
    // The line is outside the box, so the nearest pair has a corner of the box or an end of the
    // line.
    let from_corners = corners.map(|p| point_line_distance(p, line));
    let from_ends = [line.p0, line.p1].map(|p| (p - clamp(p, area)).hypot());
    from_corners
        .into_iter()
        .chain(from_ends)
        .fold(f64::INFINITY, f64::min)
}

fn clamp(p: Point, area: Rect) -> Point {
    Point::new(p.x.clamp(area.x0, area.x1), p.y.clamp(area.y0, area.y1))
}

fn point_line_distance(p: Point, line: Line) -> f64 {
    let d = line.p1 - line.p0;
    let length_squared = d.hypot2();
    let t = if length_squared > 0.0 {
        ((p - line.p0).dot(d) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p - (line.p0 + t * d)).hypot()
}

/// Whether two segments cross in a point inside both. Where they only touch, an end lies on the
/// other segment and the distances of ends are 0.
fn cross(a: Line, b: Line) -> bool {
    let side = |l: Line, p: Point| Vec2::cross(l.p1 - l.p0, p - l.p0);
    let (a0, a1) = (side(b, a.p0), side(b, a.p1));
    let (b0, b1) = (side(a, b.p0), side(a, b.p1));
    a0 * a1 < 0.0 && b0 * b1 < 0.0
}
