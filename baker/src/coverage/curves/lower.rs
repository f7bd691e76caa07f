//! Lowering: outlines become monotone lines and quadratics between points of the curve lattice.
//!
//! A curve is always cut in the same of its two directions. So an edge that two shapes share,
//! running one way in one and the other way in the other, becomes the same segments in both: no
//! seam.

use kurbo::{BezPath, CubicBez, PathEl, Point, QuadBez};
use vtex_format::cut::parameter;

use super::CurveError;

/// Largest coordinate in units. Up to here f64 keeps cuts far more precise than a unit. A canvas of
/// 128 cells is 2^23 units wide.
const MAX_COORDINATE: f64 = (1_u64 << 40) as f64;
/// Most quadratics that a monotone part of a cubic becomes. A part that needs more is less exact
/// than asked. An arc across the whole canvas at the largest zoom takes about 30.
const MAX_QUADS: u32 = 1024;
/// Share of a cubic's parameter range that one quadratic covers at least, whatever its error.
const SHORTEST_STEP: f64 = 1.0 / 1024.0;
/// How much longer than the last step the next may be.
const STEP_GROWTH: f64 = 1.5;

/// A line or quadratic that is monotone in x and in y. It runs from its upper to its lower end, or
/// left to right if both have the same height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    /// Upper end, on the lattice.
    pub(crate) start: Point,
    /// Control point of a quadratic, inside the box of the ends: that makes it monotone.
    pub(crate) control: Option<Point>,
    /// Lower end, on the lattice.
    pub(crate) end: Point,
    /// 1 if the outline runs from start to end, -1 if it runs back.
    pub(crate) direction: i32,
}

impl Segment {
    /// Smallest x.
    #[cfg(any(test, feature = "oracle"))]
    pub(crate) fn x_min(&self) -> f64 {
        self.start.x.min(self.end.x)
    }

    /// Largest x.
    #[cfg(any(test, feature = "oracle"))]
    pub(crate) fn x_max(&self) -> f64 {
        self.start.x.max(self.end.x)
    }

    /// The blossom: for `s = t` the point at that parameter, else the control point of the part
    /// between the two.
    pub(crate) fn blossom(&self, s: f64, t: f64) -> Point {
        let (a, b) = (self.start.to_vec2(), self.end.to_vec2());
        let point = match self.control {
            // A line's control point is its middle.
            None => a.lerp(b, 0.5 * (s + t)),
            Some(c) => {
                let c = c.to_vec2();
                (1.0 - s) * (1.0 - t) * a + (s * (1.0 - t) + t * (1.0 - s)) * c + s * t * b
            }
        };
        point.to_point()
    }
}

/// An outline in units, ready to be cut.
#[derive(Clone, Debug, Default)]
pub(crate) struct LoweredOutline {
    /// The segments of all contours, in the order of the outline. Every contour is a closed chain.
    pub(crate) segments: Vec<Segment>,
}

impl LoweredOutline {
    /// Lowers an outline whose coordinates are in units. Open contours are closed. Quadratics
    /// replace cubics within `tolerance` units.
    ///
    /// # Errors
    /// [`CurveError::Range`] for coordinates that are not finite or too large.
    pub(crate) fn new(outline: &BezPath, tolerance: f64) -> Result<Self, CurveError> {
        let mut lowering = Lowering {
            segments: Vec::new(),
            tolerance,
        };
        let (mut first, mut here) = (Point::ZERO, Point::ZERO);
        for element in outline.elements() {
            check_range(element)?;
            match *element {
                PathEl::MoveTo(p) => {
                    // A move ends the contour before it. Close that one: an open contour would
                    // leak.
                    lowering.line(here, first);
                    (first, here) = (p, p);
                }
                PathEl::LineTo(p) => {
                    lowering.line(here, p);
                    here = p;
                }
                PathEl::QuadTo(c, p) => {
                    lowering.quad(QuadBez::new(here, c, p));
                    here = p;
                }
                PathEl::CurveTo(c, d, p) => {
                    lowering.cubic(CubicBez::new(here, c, d, p));
                    here = p;
                }
                PathEl::ClosePath => {
                    lowering.line(here, first);
                    here = first;
                }
            }
        }
        // The last contour has no move behind it.
        lowering.line(here, first);
        Ok(Self {
            segments: lowering.segments,
        })
    }
}

fn check_range(element: &PathEl) -> Result<(), CurveError> {
    let points = match *element {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => [p; 3],
        PathEl::QuadTo(c, p) => [c, p, p],
        PathEl::CurveTo(c, d, p) => [c, d, p],
        PathEl::ClosePath => return Ok(()),
    };
    let fits = |p: &Point| p.x.abs() <= MAX_COORDINATE && p.y.abs() <= MAX_COORDINATE;
    if points.iter().all(fits) {
        Ok(())
    } else {
        Err(CurveError::Range)
    }
}

struct Lowering {
    segments: Vec<Segment>,
    tolerance: f64,
}

impl Lowering {
    fn line(&mut self, from: Point, to: Point) {
        self.push(from.round(), None, to.round());
    }

    fn quad(&mut self, quad: QuadBez) {
        let first = self.segments.len();
        // Always cut in the same direction: see the module.
        let (quad, forward) = if is_canonical(quad.p0, quad.p2, quad.p1, quad.p1) {
            (quad, true)
        } else {
            (QuadBez::new(quad.p2, quad.p1, quad.p0), false)
        };
        // Not monotone yet; only its blossom is used.
        let whole = Segment {
            start: quad.p0,
            control: Some(quad.p1),
            end: quad.p2,
            direction: 1,
        };
        let axes = [
            [quad.p0.x, quad.p1.x, quad.p2.x],
            [quad.p0.y, quad.p1.y, quad.p2.y],
        ];
        // At these parameters x or y turns.
        let mut cuts: Vec<f64> = axes
            .map(|[a, b, c]| (a - b) / (a - 2.0 * b + c))
            .into_iter()
            .filter(|t| *t > 0.0 && *t < 1.0)
            .collect();
        cuts.sort_by(f64::total_cmp);
        let mut from = (0.0, quad.p0.round());
        for t in cuts.into_iter().chain([1.0]) {
            // Rounded once, and the next part starts there.
            let end = whole.blossom(t, t).round();
            // Exact for the unrounded ends. Rounding the ends bends the part by about half a unit.
            let control = whole.blossom(from.0, t);
            self.push_along(forward, from.1, control, end);
            from = (t, end);
        }
        self.put_in_order(first, forward);
    }

    fn cubic(&mut self, cubic: CubicBez) {
        let first = self.segments.len();
        let (cubic, forward) = if is_canonical(cubic.p0, cubic.p3, cubic.p1, cubic.p2) {
            (cubic, true)
        } else {
            let reversed = CubicBez::new(cubic.p3, cubic.p2, cubic.p1, cubic.p0);
            (reversed, false)
        };
        let mut cuts = extrema([cubic.p0.x, cubic.p1.x, cubic.p2.x, cubic.p3.x]);
        // The same parameter may turn both coordinates.
        cuts.extend(extrema([cubic.p0.y, cubic.p1.y, cubic.p2.y, cubic.p3.y]));
        cuts.sort_by(f64::total_cmp);
        let mut from = 0.0;
        for t in cuts.into_iter().chain([1.0]) {
            // Equal parameters would give a piece of no length.
            if t > from {
                self.monotone_cubic(&subcubic(&cubic, from, t), forward);
                from = t;
            }
        }
        self.put_in_order(first, forward);
    }

    /// Replaces a cubic that is monotone in x and in y by quadratics, each as long as the tolerance
    /// allows.
    fn monotone_cubic(&mut self, cubic: &CubicBez, forward: bool) {
        let mut from = 0.0;
        // Try the whole part first: most need one quadratic.
        let mut step = 1.0_f64;
        for _ in 0..MAX_QUADS {
            let (to, quad) = longest_quad(cubic, from, step, self.tolerance);
            self.push_along(forward, quad.p0.round(), quad.p1, quad.p2.round());
            if to >= 1.0 {
                break;
            }
            (from, step) = (to, STEP_GROWTH * (to - from));
        }
    }

    /// Puts the segments from index `first` on into the order of the outline, if the curve was cut
    /// backwards.
    fn put_in_order(&mut self, first: usize, forward: bool) {
        if !forward {
            self.segments[first..].reverse();
        }
    }

    fn push_along(&mut self, forward: bool, from: Point, control: Point, to: Point) {
        if forward {
            self.push(from, Some(control), to);
        } else {
            self.push(to, Some(control), from);
        }
    }

    /// Appends a segment between two lattice points, unless they are the same point.
    fn push(&mut self, from: Point, control: Option<Point>, to: Point) {
        if from == to {
            return;
        }
        // Equal heights are ordered by x, so that every segment has one canonical direction.
        let down = (from.y, from.x) < (to.y, to.x);
        let (start, end) = if down { (from, to) } else { (to, from) };
        // Rounding may push the control point out of the box; inside it the segment stays monotone.
        let control = control.map(|c| clamp_to_box(c.round(), start, end));
        self.segments.push(Segment {
            start,
            // With its control point at an end a quadratic is a line.
            control: control.filter(|c| *c != start && *c != end),
            end,
            direction: if down { 1 } else { -1 },
        });
    }
}

/// Whether a curve runs in the direction in which curves are cut. The key orders both directions of
/// any curve, and differs for them unless the curve is symmetric.
fn is_canonical(start: Point, end: Point, after: Point, before: Point) -> bool {
    let key = |p: Point, q: Point| (p.y, p.x, q.y, q.x);
    key(start, after) <= key(end, before)
}

/// `p` moved into the box of two opposite corners.
fn clamp_to_box(p: Point, a: Point, b: Point) -> Point {
    Point::new(
        p.x.clamp(a.x.min(b.x), a.x.max(b.x)),
        p.y.clamp(a.y.min(b.y), a.y.max(b.y)),
    )
}

/// Parameters in (0, 1) at which a coordinate of a cubic has an extremum.
fn extrema([p0, p1, p2, p3]: [f64; 4]) -> Vec<f64> {
    let (d0, d1, d2) = (p1 - p0, p2 - p1, p3 - p2);
    let (a, b, c) = (d0 - 2.0 * d1 + d2, d1 - d0, d0);
    // Roots of a t^2 + 2 b t + c, by the form without cancellation.
    let discriminant = b * b - a * c;
    if discriminant <= 0.0 {
        return Vec::new();
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    // Division by zero gives infinity or NaN, which the range below excludes.
    let roots = [q / a, c / q];
    roots.into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect()
}

/// The part of a cubic between two parameters. Its ends are bit-exact at 0 and 1.
fn subcubic(cubic: &CubicBez, from: f64, to: f64) -> CubicBez {
    // The blossom of the cubic: de Casteljau with a parameter of its own in each round.
    let at = |r: f64, s: f64, t: f64| {
        let ends = [cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(Point::to_vec2);
        let first = [0, 1, 2].map(|i| ends[i].lerp(ends[i + 1], r));
        let second = [0, 1].map(|i| first[i].lerp(first[i + 1], s));
        second[0].lerp(second[1], t).to_point()
    };
    CubicBez::new(
        if from <= 0.0 {
            cubic.p0
        } else {
            at(from, from, from)
        },
        at(from, from, to),
        at(from, to, to),
        if to >= 1.0 { cubic.p3 } else { at(to, to, to) },
    )
}

/// A quadratic that follows `cubic` from parameter `from` within `tolerance`, and the parameter at
/// which it ends: about `step` further, or less if the tolerance demands it.
fn longest_quad(cubic: &CubicBez, from: f64, step: f64, tolerance: f64) -> (f64, QuadBez) {
    let mut step = step.min(1.0);
    loop {
        let rest = 1.0 - from;
        // A slightly longer step is better than a tiny one after it.
        let to = if 1.25 * step >= rest {
            1.0
        } else {
            from + step
        };
        let part = subcubic(cubic, from, to);
        let (quad, error) = best_quad(&part);
        if error <= tolerance || to - from <= SHORTEST_STEP {
            return (to, quad);
        }
        // The error falls with the fourth power of the step.
        let shrink = 0.95 * (tolerance / error).sqrt().sqrt();
        step = (to - from) * shrink.clamp(0.1, 0.75);
    }
}

/// The better of two quadratics for a monotone cubic, with its error. A control point where the end
/// tangents meet gives a smooth join and an error of fourth order. Where the tangents do not meet,
/// as at a point of inflection, the control point that keeps the middle serves.
fn best_quad(cubic: &CubicBez) -> (QuadBez, f64) {
    let [p0, p1, p2, p3] = [cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(Point::to_vec2);
    let with = |control: Point| {
        let control = clamp_to_box(control, cubic.p0, cubic.p3);
        let quad = QuadBez::new(cubic.p0, control, cubic.p3);
        (quad, quad_error(cubic, &quad))
    };
    // The control point for which both curves have the same point at t = 1/2.
    let middle = with((0.25 * (3.0 * (p1 + p2) - p0 - p3)).to_point());
    let (a, b) = (p1 - p0, p3 - p2);
    // Where the tangents at both ends meet, in lengths of the first.
    let along = (p3 - p0).cross(b) / a.cross(b);
    let meets = along.is_finite() && along > 0.0;
    let tangent = meets.then(|| with((p0 + along * a).to_point()));
    match tangent {
        // The smoother one is taken if it is as good.
        Some(tangent) if tangent.1 <= middle.1 => tangent,
        _ => middle,
    }
}

/// The largest distance between two monotone curves with the same ends, at sampled places. It is
/// measured across their chord, which is never less than the true distance at that place.
fn quad_error(cubic: &CubicBez, quad: &QuadBez) -> f64 {
    let chord = cubic.p3 - cubic.p0;
    // In coordinates along and across the chord.
    let chord = chord / chord.hypot();
    if !chord.is_finite() {
        return 0.0;
    }
    let local = |p: Point| {
        let v = p - cubic.p0;
        (v.dot(chord), v.cross(chord))
    };
    let [_, c1, c2, c3] = [cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(local);
    let (control, end) = (local(quad.p1), c3.0);
    let gap = |t: f64| {
        let s = 1.0 - t;
        let weights = [3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let x = weights[0] * c1.0 + weights[1] * c2.0 + weights[2] * end;
        let y = weights[0] * c1.1 + weights[1] * c2.1;
        // The quadratic at the same place along the chord; both curves are monotone along it.
        let u = parameter(0.0, Some(control.0), end, x);
        (y - 2.0 * (1.0 - u) * u * control.1).abs()
    };
    // Seven places find the largest error of curves that differ this little.
    let places = [0.1, 0.22, 0.36, 0.5, 0.64, 0.78, 0.9];
    places.into_iter().map(gap).fold(0.0, f64::max)
}
