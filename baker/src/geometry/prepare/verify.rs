//! Whether a simplified outline fills what the drawing fills.

use kurbo::{BezPath, Line, ParamCurve, PathSeg, Point, Vec2};

use super::simplify::SIMPLIFY_EPS;
use crate::{
    drawing::FillRule,
    geometry::{Region, flatten, line_line_distance, spread_point, tangent},
    number::count,
};

/// Points compared all over the shape's box.
const AREA_POINTS: u32 = 64;
/// Places along the edge at which points on both sides are compared, spread over its segments.
const EDGE_POINTS: usize = 256;
/// Distance of those points from the edge, in the units of simplification. Nearer points may
/// differ, because a method may move the edge.
const STAND_OFF: f64 = 100.0 * SIMPLIFY_EPS;
/// Distance from the drawing's edges within which the two may differ.
const NEAR: f64 = 20.0 * SIMPLIFY_EPS;

/// Whether `simple` with the non-zero rule fills the same points as `outline` with `rule`, except
/// close to the edges of `outline`.
pub(super) fn agrees(outline: &BezPath, rule: FillRule, simple: &BezPath) -> bool {
    if !simple.is_finite() {
        return false;
    }
    let before = Region::new(outline, rule);
    let after = Region::new(simple, FillRule::NonZero);
    let area = before.bounds();
    let spread = (1..=AREA_POINTS).map(|k| {
        let [u, v] = spread_point(k);
        Point::new(area.x0 + u * area.width(), area.y0 + v * area.height())
    });
    // Near an edge both answers are right, because the edge may have moved.
    let same = |p: Point| before.contains(p) == after.contains(p) || near_edge(outline, p);
    spread.chain(beside_edges(outline)).all(same)
}

/// Points on both sides of the edge, equally many for each segment. An outline with more than
/// [`EDGE_POINTS`] segments has points at some of them only.
fn beside_edges(outline: &BezPath) -> impl Iterator<Item = Point> {
    let segment_count = outline.segments().count();
    let every = segment_count.div_ceil(EDGE_POINTS).max(1);
    let each = (EDGE_POINTS / segment_count.max(1)).max(1);
    let segments = outline.segments().step_by(every);
    segments.flat_map(move |segment| {
        (0..each).flat_map(move |k| {
            let t = (count(k) + 0.5) / count(each);
            beside(&segment, t).into_iter().flatten()
        })
    })
}

/// A point on each side of a segment; `None` where the segment has no direction.
fn beside(segment: &PathSeg, t: f64) -> Option<[Point; 2]> {
    let tangent = tangent(segment, t);
    // A segment without direction gives NaN here.
    let across = STAND_OFF * Vec2::new(-tangent.y, tangent.x).normalize();
    let p = segment.eval(t);
    across.is_finite().then_some([p + across, p - across])
}

fn near_edge(outline: &BezPath, p: Point) -> bool {
    let point = Line::new(p, p);
    flatten(outline, SIMPLIFY_EPS).iter().any(|contour| {
        let mut lines = contour.windows(2).map(|ends| Line::new(ends[0], ends[1]));
        lines.any(|line| line_line_distance(line, point) < NEAR)
    })
}
