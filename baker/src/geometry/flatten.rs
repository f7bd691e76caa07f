//! Outlines as short straight lines, within a stated tolerance.

use kurbo::{BezPath, Line, ParamCurve, PathEl, PathSeg, Point, Rect};

use crate::number::{count, floor_index};

/// Most lines that one segment is cut into. A segment that needs more is coarser than asked.
const MAX_LINES: f64 = 65_536.0;

/// The points of a contour in order.
type Polyline = Vec<Point>;

/// Appends the end points of the lines that replace `segment`. Its start is not appended. No line
/// is further than `tolerance` from the curve.
pub(crate) fn flatten_segment(segment: PathSeg, tolerance: f64, points: &mut Polyline) {
    let bend = match segment {
        PathSeg::Line(_) => 0.0,
        PathSeg::Quad(q) => 2.0 * (q.p0.to_vec2() - 2.0 * q.p1.to_vec2() + q.p2.to_vec2()).hypot(),
        PathSeg::Cubic(c) => {
            let first = (c.p0.to_vec2() - 2.0 * c.p1.to_vec2() + c.p2.to_vec2()).hypot();
            let second = (c.p1.to_vec2() - 2.0 * c.p2.to_vec2() + c.p3.to_vec2()).hypot();
            6.0 * first.max(second)
        }
    };
    // A chord over a step h of the parameter leaves the curve by at most h^2 max|B''| / 8. `bend`
    // is that largest second derivative: constant for a quadratic, largest at an end for a cubic.
    let lines = (bend / (8.0 * tolerance))
        .sqrt()
        .ceil()
        .clamp(1.0, MAX_LINES);
    for k in 1..floor_index(lines) {
        let t = count(k) / lines;
        points.push(segment.eval(t));
    }
    points.push(segment.end());
}

/// One polyline for each contour. A contour without length has none.
pub(crate) fn flatten(outline: &BezPath, tolerance: f64) -> Vec<Polyline> {
    let mut contours = Vec::new();
    let mut points: Polyline = Vec::new();
    let elements = outline.elements();
    for (i, element) in elements.iter().enumerate() {
        match element {
            PathEl::MoveTo(p) => {
                push_contour(&mut contours, &mut points);
                points.push(*p);
            }
            PathEl::ClosePath => {
                let first = points.first().copied();
                // Repeat the first point, unless the contour already ends there.
                if first != points.last().copied() {
                    points.extend(first);
                }
            }
            _ => {
                if let Some(segment) = outline.get_seg(i) {
                    flatten_segment(segment, tolerance, &mut points);
                }
            }
        }
    }
    push_contour(&mut contours, &mut points);
    contours
}

fn push_contour(contours: &mut Vec<Polyline>, points: &mut Polyline) {
    if points.len() > 1 {
        contours.push(std::mem::take(points));
    } else {
        points.clear();
    }
}

/// The part of `line` inside `window` (Liang and Barsky 1984), `None` when there is none.
pub(crate) fn clip_line(line: Line, window: Rect) -> Option<Line> {
    let d = line.p1 - line.p0;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (p, q) in [
        (-d.x, line.p0.x - window.x0),
        (d.x, window.x1 - line.p0.x),
        (-d.y, line.p0.y - window.y0),
        (d.y, window.y1 - line.p0.y),
    ] {
        // The line is parallel to this side: all of it lies on one side of it.
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            enter = enter.max(q / p);
        } else {
            leave = leave.min(q / p);
        }
    }
    if enter > leave {
        return None;
    }
    // Where nothing is cut the ends stay bit-exact: a caller can see that lines still join.
    let at = |t: f64| match t {
        0.0 => line.p0,
        1.0 => line.p1,
        _ => line.p0 + t * d,
    };
    Some(Line::new(at(enter), at(leave)))
}

/// `line` in equal pieces no longer than `longest`, so that the box around each is mostly line.
/// Pieces that follow each other share the bit-exact point.
pub(crate) fn pieces(line: Line, longest: f64) -> impl Iterator<Item = Line> {
    let pieces = ((line.p1 - line.p0).hypot() / longest).ceil().max(1.0);
    let at = move |k: usize| line.p0.lerp(line.p1, count(k) / pieces);
    (0..floor_index(pieces)).map(move |k| Line::new(at(k), at(k + 1)))
}
