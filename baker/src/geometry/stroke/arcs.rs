//! Round joins and caps, drawn again at the wanted tolerance.
//!
//! kurbo (0.13) draws their arcs to a thousandth of the half width whatever tolerance it is given,
//! which is most of a pixel at high zoom. Its output does not say which cubics are arcs. They are
//! found by their geometry: a cubic is replaced only if it runs along a circle of the stroke's half
//! width around a point of the line.

use std::f64::consts::TAU;

use kurbo::{Arc, BezPath, CubicBez, ParamCurve as _, PathEl, Point, Vec2};

/// How far the ends of a cubic may be off a circle for it to count as an arc, in half widths.
const ALIKE: f64 = 1e-6;

/// The outline with its arcs exact to `tolerance`. It is the stroke of `line` with half width
/// `radius`.
pub(super) fn refine(outline: &BezPath, line: &BezPath, radius: f64, tolerance: f64) -> BezPath {
    let corners = Corners::new(line, radius);
    // Cubics in a full circle, by the formula of kurbo's own conversion of arcs: the error falls
    // with the sixth power of their number.
    let pieces = (1.1163 * radius / tolerance)
        .powf(1.0 / 6.0)
        .max(4.0)
        .ceil();
    let mut refined = BezPath::new();
    let mut here = Point::ZERO;
    for &element in outline.elements() {
        let arc = match element {
            PathEl::CurveTo(c, d, p) => corners.arc(CubicBez::new(here, c, d, p), radius),
            _ => None,
        };
        match (arc, element.end_point()) {
            (Some(arc), Some(end)) => {
                let count = (arc.sweep_angle.abs() * pieces / TAU).ceil().max(1.0);
                push(&mut refined, &arc, count, end);
            }
            _ => refined.push(element),
        }
        here = element.end_point().unwrap_or(here);
    }
    refined
}

/// Appends `count` cubics along `arc`, the last of which ends bit for bit at `end`.
fn push(path: &mut BezPath, arc: &Arc, count: f64, end: Point) {
    let step = arc.sweep_angle / count;
    // The handle length with which the middle of the cubic lies on the circle.
    let handle = 4.0 / 3.0 * (0.25 * step).tan();
    let on_circle = |angle: f64| arc.radii.x * Vec2::from_angle(angle);
    let turned = |v: Vec2| Vec2::new(-v.y, v.x);
    let mut index = 0.0;
    while index < count {
        let [from, to] = [index, index + 1.0].map(|k| on_circle(arc.start_angle + k * step));
        index += 1.0;
        let to_point = if index < count { arc.center + to } else { end };
        path.curve_to(
            arc.center + from + handle * turned(from),
            arc.center + to - handle * turned(to),
            to_point,
        );
    }
}

/// Points at which a line can have joins and caps, sorted by x.
struct Corners {
    points: Vec<Point>,
    slack: f64,
}

impl Corners {
    fn new(line: &BezPath, radius: f64) -> Self {
        let ends = line.elements().iter().filter_map(PathEl::end_point);
        let mut points: Vec<Point> = ends.collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        Self {
            points,
            slack: ALIKE * radius,
        }
    }

    /// The arc that `cubic` approximates: part of a circle of `radius` around a corner.
    fn arc(&self, cubic: CubicBez, radius: f64) -> Option<Arc> {
        let [start, end] = [cubic.p1 - cubic.p0, cubic.p3 - cubic.p2];
        // The centre lies one radius from the start, at right angles to the tangent, on the side to
        // which the curve turns.
        let inward = Vec2::new(-start.y, start.x) * (radius / start.hypot());
        let turn = start.cross(end);
        let inward = if turn < 0.0 { -inward } else { inward };
        let center = self.near(cubic.p0 + inward)?;
        // A centre that is a point of the line was found. Check the rest of the cubic against its
        // circle.
        let [from, to] = [cubic.p0 - center, cubic.p3 - center];
        let on_circle = |v: Vec2| (v.hypot() - radius).abs() <= self.slack;
        // kurbo puts the middle within a thousandth of the radius; twice that is accepted.
        let middle = (cubic.eval(0.5) - center).hypot();
        // The tangent at the end must be at right angles to the radius too.
        let along = end.dot(to).abs() <= self.slack * end.hypot();
        let round = on_circle(from) && on_circle(to) && along;
        let close = (middle - radius).abs() <= 2e-3 * radius;
        (round && close).then(|| {
            let sweep = from.cross(to).atan2(from.dot(to));
            Arc::new(center, (radius, radius), from.atan2(), sweep, 0.0)
        })
    }

    fn near(&self, p: Point) -> Option<Point> {
        let first = self.points.partition_point(|q| q.x < p.x - self.slack);
        let near = self.points[first..]
            .iter()
            .take_while(|q| q.x <= p.x + self.slack);
        near.copied().find(|q| (q.y - p.y).abs() <= self.slack)
    }
}

#[cfg(test)]
mod tests {
    use kurbo::{Cap, Join, ParamCurve as _, Stroke, StrokeOpts};

    use super::*;

    /// Largest distance from the circles about the corners of the curves of a stroke.
    fn error(outline: &BezPath, corners: &[Point], radius: f64) -> f64 {
        let curves = outline
            .segments()
            .filter(|s| matches!(s, kurbo::PathSeg::Cubic(_)));
        let places = curves.flat_map(|s| (0..=64).map(move |k| s.eval(f64::from(k) / 64.0)));
        let miss = |p: Point| {
            let from = corners.iter().map(|c| (p.distance(*c) - radius).abs());
            from.fold(f64::INFINITY, f64::min)
        };
        places.map(miss).fold(0.0, f64::max)
    }

    #[test]
    fn joins_and_caps_are_as_round_as_asked() {
        let line = BezPath::from_svg("M10 10L90 20L30 70L35 12").unwrap();
        let corners = [(10.0, 10.0), (90.0, 20.0), (30.0, 70.0), (35.0, 12.0)].map(Point::from);
        let style = Stroke::new(24.0)
            .with_join(Join::Round)
            .with_caps(Cap::Round);
        let coarse = kurbo::stroke(line.iter(), &style, &StrokeOpts::default(), 1e-5);
        assert!(error(&coarse, &corners, 12.0) > 1e-3);
        let fine = refine(&coarse, &line, 12.0, 1e-5);
        assert!(error(&fine, &corners, 12.0) < 1.1e-5);
        let gain = fine.elements().len() as f64 / coarse.elements().len() as f64;
        assert!(gain < 2.5, "{gain}");
    }

    #[test]
    fn curves_that_are_no_arcs_stay() {
        // The inner offset of this circle has the half width for its radius.
        let line = kurbo::Shape::to_path(&kurbo::Circle::new((50.0, 50.0), 20.0), 1e-3);
        let outline = kurbo::stroke(
            line.iter(),
            &Stroke::new(20.0),
            &StrokeOpts::default(),
            1e-4,
        );
        assert_eq!(refine(&outline, &line, 10.0, 1e-6), outline);
    }
}
