//! One segment against one cell's box, in binary64 arithmetic that every machine does alike: sums,
//! products, quotients, square roots, `round` (halves away from zero). `docs/format.md` section
//! 2.14 gives the same in formulas.

use super::CellBox;

/// A place in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Down.
    pub y: f64,
}

impl Point {
    /// The place `(x, y)`.
    pub fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    pub(crate) fn of([x, y]: [i32; 2]) -> Self {
        Self::new(f64::from(x), f64::from(y))
    }

    fn minus(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }

    fn cross(self, other: Self) -> f64 {
        self.x * other.y - self.y * other.x
    }

    fn clamped(self, a: Self, b: Self) -> Self {
        Self::new(
            self.x.max(a.x.min(b.x)).min(a.x.max(b.x)),
            self.y.max(a.y.min(b.y)).min(a.y.max(b.y)),
        )
    }
}

/// A monotone segment from its upper to its lower end (equal heights: left to right).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Upper end, on the lattice.
    pub start: Point,
    /// Control point of a quadratic, inside the box of the ends.
    pub control: Option<Point>,
    /// Lower end, on the lattice.
    pub end: Point,
    /// 1 where the outline runs from start to end, -1 where it runs back.
    pub direction: i32,
}

impl Segment {
    /// Smallest x.
    pub fn x_min(&self) -> f64 {
        self.start.x.min(self.end.x)
    }

    /// Largest x.
    pub fn x_max(&self) -> f64 {
        self.start.x.max(self.end.x)
    }

    /// The parts above and below a height strictly between the ends'; they share a lattice point.
    #[must_use]
    pub fn halves_at(&self, height: f64) -> [Self; 2] {
        let control_y = self.control.map(|c| c.y);
        let t = parameter(self.start.y, control_y, self.end.y, height);
        // Rounded once, for both parts; the clamp keeps both monotone.
        let x = self.blossom(t, t).x.round();
        let cut = Point::new(x.max(self.x_min()).min(self.x_max()), height);
        let part = |start: Point, end: Point, from: f64, to: f64| Self {
            start,
            control: self.control.map(|_| {
                let control = self.blossom(from, to);
                Point::new(control.x.round(), control.y.round()).clamped(start, end)
            }),
            end,
            direction: self.direction,
        };
        [part(self.start, cut, 0.0, t), part(cut, self.end, t, 1.0)]
    }

    /// Blossom: the point at `s = t`, and the control point of the part between `s` and `t`.
    fn blossom(&self, s: f64, t: f64) -> Point {
        let axis = |a: f64, c: Option<f64>, b: f64| match c {
            None => a + 0.5 * (s + t) * (b - a),
            Some(c) => (1.0 - s) * (1.0 - t) * a + (s * (1.0 - t) + t * (1.0 - s)) * c + s * t * b,
        };
        Point::new(
            axis(self.start.x, self.control.map(|c| c.x), self.end.x),
            axis(self.start.y, self.control.map(|c| c.y), self.end.y),
        )
    }
}

/// How a segment lies to a box.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clipped {
    /// The part in the box, relative to its corner.
    pub(crate) inside: Option<Segment>,
    /// Heights, relative to the box's top, between which the segment passes left of the box.
    pub(crate) left: Option<[f64; 2]>,
}

/// A point of the segment: parameter and rounded place.
#[derive(Clone, Copy)]
struct Cut {
    t: f64,
    point: Point,
}

/// Cuts `segment`, which reaches into the box's rows, to the box. Parts above, below and right of
/// it vanish.
pub(crate) fn clip(segment: &Segment, cell: &CellBox) -> Clipped {
    let low = cell.origin;
    let high = Point::new(low.x + cell.size, low.y + cell.size);
    // What follows says the same of segments wholly beside the box, at the price of their cuts.
    // Half open: a segment on the right edge lies outside, one on the left edge passes left of the
    // box and is a step.
    if segment.x_min() >= high.x {
        return Clipped::default();
    }
    if segment.x_max() <= low.x {
        let [top, bottom] = [segment.start.y.max(low.y), segment.end.y.min(high.y)];
        return Clipped {
            inside: None,
            left: (top < bottom).then_some([top - low.y, bottom - low.y]),
        };
    }
    let mut first = Cut {
        t: 0.0,
        point: segment.start,
    };
    let mut last = Cut {
        t: 1.0,
        point: segment.end,
    };
    if first.point.y < low.y {
        first = cut_at_height(segment, low.y);
    }
    if last.point.y > high.y {
        last = cut_at_height(segment, high.y);
    }
    if first.point.x.max(last.point.x) <= low.x {
        return Clipped {
            inside: None,
            left: span(first, last, cell),
        };
    }
    if first.point.x.min(last.point.x) >= high.x {
        return Clipped::default();
    }
    let mut left = None;
    // The right cut comes first where the left one comes last, so that the left one, whose height
    // becomes a step, is what the order of the two heights is measured against.
    if first.point.x <= last.point.x {
        if first.point.x < low.x {
            let cut = cut_at_x(segment, low.x, first, last);
            left = span(first, cut, cell);
            first = cut;
        }
        if last.point.x > high.x {
            last = cut_at_x(segment, high.x, first, last);
        }
    } else {
        if last.point.x < low.x {
            let cut = cut_at_x(segment, low.x, first, last);
            left = span(cut, last, cell);
            last = cut;
        }
        if first.point.x > high.x {
            first = cut_at_x(segment, high.x, first, last);
        }
    }
    Clipped {
        inside: between(segment, first, last, cell),
        left,
    }
}

fn span(first: Cut, last: Cut, cell: &CellBox) -> Option<[f64; 2]> {
    let heights = [first, last].map(|cut| cut.point.y - cell.origin.y);
    (heights[0] < heights[1]).then_some(heights)
}

fn cut_at_height(segment: &Segment, y: f64) -> Cut {
    let t = parameter(
        segment.start.y,
        segment.control.map(|c| c.y),
        segment.end.y,
        y,
    );
    let x = segment.blossom(t, t).x.round();
    let x = x.max(segment.x_min()).min(segment.x_max());
    Cut {
        t,
        point: Point::new(x, y),
    }
}

/// Its height is rounded and lies between those of `first` and `last`.
fn cut_at_x(segment: &Segment, x: f64, first: Cut, last: Cut) -> Cut {
    let t = parameter(
        segment.start.x,
        segment.control.map(|c| c.x),
        segment.end.x,
        x,
    );
    // Rounding of t must not carry this cut past the others: heights would run backwards.
    let t = t.max(first.t).min(last.t);
    let y = segment.blossom(t, t).y.round();
    let y = y.max(first.point.y).min(last.point.y);
    Cut {
        t,
        point: Point::new(x, y),
    }
}

/// Where a monotone coordinate with the values `p0`, `control`, `p2` takes the value `v`, which lies
/// between its ends; in \[0, 1\].
pub fn parameter(p0: f64, control: Option<f64>, p2: f64, v: f64) -> f64 {
    let t = match control {
        None => (v - p0) / (p2 - p0),
        Some(p1) => {
            // a t^2 + 2 b t = v - p0. The slope a t + b at the root is the square root of the
            // discriminant with the sign of p2 - p0, which b shares: nothing cancels.
            let (a, b) = (p0 - 2.0 * p1 + p2, p1 - p0);
            let slope = (b * b + a * (v - p0)).max(0.0).sqrt();
            (v - p0) / (b + slope.copysign(p2 - p0))
        }
    };
    // 0 / 0 where the segment does not move along this axis.
    if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) }
}

/// The part between two cuts, relative to the box; `None` for a point.
fn between(segment: &Segment, first: Cut, last: Cut, cell: &CellBox) -> Option<Segment> {
    let local = |p: Point| p.minus(cell.origin);
    let (start, end) = (local(first.point), local(last.point));
    // Rounding may leave nothing of a short part.
    if start == end {
        return None;
    }
    let control = segment.control.and_then(|_| {
        let control = local(segment.blossom(first.t, last.t));
        let control = Point::new(control.x.round(), control.y.round()).clamped(start, end);
        // The curve leaves its chord by half of what its control point does.
        let chord = end.minus(start);
        let length = (chord.x * chord.x + chord.y * chord.y).sqrt();
        let height = chord.cross(control.minus(start)).abs() / length;
        (0.5 * height > cell.flatness).then_some(control)
    });
    Some(Segment {
        start,
        control,
        end,
        direction: segment.direction,
    })
}
