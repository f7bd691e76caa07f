//! Whether a simplified outline fills what the drawing fills.

use kurbo::{BezPath, Line, ParamCurve, ParamCurveDeriv, PathSeg, Point, Vec2};

use super::simplify::SIMPLIFY_EPS;
use crate::{
    drawing::FillRule,
    geometry::{Region, flatten, line_line_distance},
};

/// Points all over the shape's box.
const AREA_POINTS: u32 = 64;
/// Points of the edge beside which the outlines are compared, spread over its segments.
const EDGE_POINTS: usize = 256;
/// Distance of those points from the edge, in simplification's units; nearer ones may differ.
const STAND_OFF: f64 = 100.0 * SIMPLIFY_EPS;
/// Within this of an edge of the drawing the two may differ.
const NEAR: f64 = 20.0 * SIMPLIFY_EPS;

/// Whether `simple`, by the non-zero rule, fills the same points as `outline` by `rule`, points
/// near the drawing's edges aside.
pub(super) fn agrees(outline: &BezPath, rule: FillRule, simple: &BezPath) -> bool {
    if !simple.is_finite() {
        return false;
    }
    let before = Region::new(outline, rule);
    let after = Region::new(simple, FillRule::NonZero);
    let area = before.bounds();
    let spread = (1..=AREA_POINTS).map(|k| {
        // The additive recurrence R2 of Roberts (2018).
        let at = |share: f64| (f64::from(k) * share).fract();
        let [u, v] = [at(0.754_877_666_246_692_8), at(0.569_840_290_998_053_3)];
        Point::new(area.x0 + u * area.width(), area.y0 + v * area.height())
    });
    let same = |p: Point| before.contains(p) == after.contains(p) || near_edge(outline, p);
    spread.chain(beside_edges(outline)).all(same)
}

/// Points on both sides of the edge, as many for each segment; of an outline of more than
/// [`EDGE_POINTS`] segments some are passed over.
fn beside_edges(outline: &BezPath) -> impl Iterator<Item = Point> {
    let count = outline.segments().count();
    let every = count.div_ceil(EDGE_POINTS).max(1);
    let each = (EDGE_POINTS / count.max(1)).max(1);
    let segments = outline.segments().step_by(every);
    segments.flat_map(move |segment| {
        (0..each).flat_map(move |k| {
            #[expect(clippy::cast_precision_loss, reason = "at most EDGE_POINTS")]
            let t = (k as f64 + 0.5) / each as f64;
            beside(&segment, t).into_iter().flatten()
        })
    })
}

/// Points to the left and to the right of a segment; none where it has no direction.
fn beside(segment: &PathSeg, t: f64) -> Option<[Point; 2]> {
    let tangent = match segment {
        PathSeg::Line(line) => line.p1 - line.p0,
        PathSeg::Quad(quad) => quad.deriv().eval(t).to_vec2(),
        PathSeg::Cubic(cubic) => cubic.deriv().eval(t).to_vec2(),
    };
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
