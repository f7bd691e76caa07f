//! Strokes as the union of simple pieces: a rectangle along each straight bit of the line, a wedge
//! at each corner, a cap at each end (SVG 2 sec. 13.5). It is slow and simple and computes in f64.
//!
//! tiny-skia 0.12 cannot draw the truth for strokes. It approximates arcs to a quarter of a user
//! unit at every scale. Along some cubics whose first handle has no length it is off by a hundredth
//! of the width, which is nine pixels at 256x, measured against distances to the curve.

use kurbo::{Cap, Join, ParamCurve as _, PathEl, PathSeg, Point, Vec2};

/// Most halvings of a segment. The direction at a cusp never settles, so that halving would not end.
const MAX_DEPTH: u32 = 14;
/// Length of the first and last bit of a segment, in its parameter from 0 to 1.
const END_BIT: f64 = 1e-5;
/// Most dashes of one path; the rest are not drawn.
const MAX_DASHES: usize = 1_000_000;

/// How a path is stroked, in the path's own space.
#[derive(Clone, Debug)]
pub(crate) struct StrokeStyle {
    /// Half the width.
    pub(crate) radius: f64,
    pub(crate) cap: Cap,
    pub(crate) join: Join,
    /// Miter length over stroke width.
    pub(crate) miter_limit: f64,
    /// Alternating on and off lengths; empty for a continuous line.
    pub(crate) dashes: Vec<f64>,
    /// Where in the dashes the line begins.
    pub(crate) dash_offset: f64,
}

/// A convex polygon that turns towards positive area.
pub(crate) type Piece = Vec<Point>;

/// A line of short straight bits.
#[derive(Clone, Debug, Default)]
struct Polyline {
    points: Vec<Point>,
    /// For each point whether it is a corner of the path, not only of its approximation.
    corners: Vec<bool>,
    closed: bool,
}

/// The pieces whose union is the stroke, up to `tolerance` away from it.
pub(crate) fn pieces(path: &kurbo::BezPath, style: &StrokeStyle, tolerance: f64) -> Vec<Piece> {
    // An arc of this angle leaves its chord by the tolerance at the stroke's edge.
    let angle = (8.0 * tolerance / style.radius).sqrt().min(0.5);
    let mut sink = Sink {
        style,
        angle,
        pieces: Vec::new(),
    };
    for line in polylines(path, tolerance, angle) {
        if style.dashes.is_empty() {
            sink.stroke(&line);
        } else {
            for dash in dashes(&line, style) {
                sink.stroke(&dash);
            }
        }
    }
    sink.pieces
}

fn polylines(path: &kurbo::BezPath, tolerance: f64, angle: f64) -> Vec<Polyline> {
    let mut lines: Vec<Polyline> = Vec::new();
    let (mut start, mut here) = (Point::ZERO, Point::ZERO);
    let mut fresh = true;
    for element in path.elements() {
        if let PathEl::MoveTo(p) = *element {
            (start, here, fresh) = (p, p, true);
            continue;
        }
        if fresh {
            lines.push(Polyline {
                points: vec![start],
                corners: vec![true],
                closed: false,
            });
            fresh = false;
        }
        let Some(line) = lines.last_mut() else {
            continue;
        };
        let segment = match *element {
            PathEl::MoveTo(_) => continue,
            PathEl::LineTo(p) => PathSeg::Line(kurbo::Line::new(here, p)),
            PathEl::QuadTo(c, p) => PathSeg::Quad(kurbo::QuadBez::new(here, c, p)),
            PathEl::CurveTo(c, d, p) => PathSeg::Cubic(kurbo::CubicBez::new(here, c, d, p)),
            PathEl::ClosePath => PathSeg::Line(kurbo::Line::new(here, start)),
        };
        line.add(&segment, tolerance, angle);
        here = segment.end();
        if matches!(element, PathEl::ClosePath) {
            line.close();
            (here, fresh) = (start, true);
        }
    }
    lines
}

impl Polyline {
    fn push(&mut self, p: Point, corner: bool) {
        if self.points.last() == Some(&p) {
            if let Some(last) = self.corners.last_mut() {
                *last |= corner;
            }
        } else {
            self.points.push(p);
            self.corners.push(corner);
        }
    }

    fn add(&mut self, segment: &PathSeg, tolerance: f64, angle: f64) {
        if !matches!(segment, PathSeg::Line(_)) {
            // The tip of a miter depends on the direction at the very end of the segment. A short
            // bit there has that direction; a longer one would not.
            let ends = [END_BIT, 1.0 - END_BIT];
            self.push(segment.eval(ends[0]), false);
            self.halve(segment, ends, tolerance, angle, MAX_DEPTH);
            self.push(segment.eval(ends[1]), false);
        }
        self.push(segment.end(), true);
    }

    /// Adds points inside `segment` between two parameters until it is straight in between.
    fn halve(
        &mut self,
        segment: &PathSeg,
        [a, b]: [f64; 2],
        tolerance: f64,
        angle: f64,
        depth: u32,
    ) {
        let middle = 0.5 * (a + b);
        let [p, quarter, q, late, r] =
            [a, 0.5 * (a + middle), middle, 0.5 * (middle + b), b].map(|t| segment.eval(t));
        let turns = |u: Vec2, v: Vec2| u.cross(v).atan2(u.dot(v)).abs() > 0.5 * angle;
        let bends = turns(quarter - p, q - quarter)
            || turns(q - quarter, late - q)
            || turns(late - q, r - late);
        let leaves = (q - p.midpoint(r)).hypot() > tolerance;
        // The first halving is free: an S may pass through the middle of its chord.
        if depth > 0 && (depth == MAX_DEPTH || bends || leaves) {
            self.halve(segment, [a, middle], tolerance, angle, depth - 1);
            self.push(q, false);
            self.halve(segment, [middle, b], tolerance, angle, depth - 1);
        }
    }

    fn close(&mut self) {
        self.closed = true;
        // The last point repeats the first.
        if self.points.len() > 1 && self.points.first() == self.points.last() {
            self.points.pop();
            self.corners.pop();
        }
    }
}

/// The dashes of a line; where a closed one begins and ends within a dash, the two are one.
fn dashes(line: &Polyline, style: &StrokeStyle) -> Vec<Polyline> {
    let total: f64 = style.dashes.iter().sum();
    let (mut index, mut left) = (0, style.dash_offset.rem_euclid(total));
    while left >= style.dashes[index] {
        left -= style.dashes[index];
        index = (index + 1) % style.dashes.len();
    }
    let mut left = style.dashes[index] - left;
    let begins_on = index % 2 == 0;
    let mut done: Vec<Polyline> = Vec::new();
    let mut dash = begins_on.then(|| line.from(0));
    let count = line.points.len();
    for k in 1..count + usize::from(line.closed) {
        let (from, to) = (line.points[k - 1], line.points[k % count]);
        let length = to.distance(from);
        let mut at = 0.0;
        while length - at > left && done.len() < MAX_DASHES {
            at += left;
            let p = from.lerp(to, at / length);
            dash = match dash.take() {
                Some(mut dash) => {
                    dash.push(p, true);
                    done.push(dash);
                    None
                }
                None => Some(Polyline {
                    points: vec![p],
                    corners: vec![true],
                    closed: false,
                }),
            };
            index = (index + 1) % style.dashes.len();
            left = style.dashes[index];
        }
        left -= length - at;
        if let Some(dash) = &mut dash {
            dash.push(to, line.corners[k % count]);
        }
    }
    if let Some(last) = dash {
        let joins = line.closed && begins_on && !done.is_empty();
        if joins {
            let first = done.remove(0);
            let mut joined = last;
            for (&p, &corner) in first.points.iter().zip(&first.corners) {
                joined.push(p, corner);
            }
            done.push(joined);
        } else {
            done.push(last);
        }
    }
    done
}

impl Polyline {
    fn from(&self, index: usize) -> Self {
        Self {
            points: vec![self.points[index]],
            corners: vec![self.corners[index]],
            closed: false,
        }
    }
}

struct Sink<'a> {
    style: &'a StrokeStyle,
    /// Largest angle between two bits of an arc.
    angle: f64,
    pieces: Vec<Piece>,
}

impl Sink<'_> {
    fn stroke(&mut self, line: &Polyline) {
        let points = &line.points;
        if points.len() < 2 {
            return self.dot(points[0]);
        }
        let bits = if line.closed {
            points.len()
        } else {
            points.len() - 1
        };
        let next = |k: usize| points[(k + 1) % points.len()];
        let side = |k: usize| {
            let along = next(k) - points[k];
            self.style.radius / along.hypot() * Vec2::new(-along.y, along.x)
        };
        let sides: Vec<Vec2> = (0..bits).map(side).collect();
        for k in 0..bits {
            let (p, q, n) = (points[k], next(k), sides[k]);
            // The middle line is part of the rectangle's outline, since wedges begin there: pieces
            // then share whole edges, the rasteriser rounds both alike, and no hole shows between.
            self.push(vec![p + n, p, p - n, q - n, q, q + n]);
        }
        for k in 0..points.len() {
            let before = match k {
                0 if line.closed => sides[bits - 1],
                0 => continue,
                _ => sides[k - 1],
            };
            if k < bits {
                self.join(points[k], before, sides[k], line.corners[k]);
            }
        }
        if !line.closed {
            self.cap(points[0], sides[0]);
            self.cap(points[points.len() - 1], -sides[bits - 1]);
        }
    }

    /// `from` and `to` point from the line to its left edge, before and after the corner.
    fn join(&mut self, p: Point, from: Vec2, to: Vec2, corner: bool) {
        // The gap is on the outer side of the turn.
        let (from, to) = if from.cross(to) > 0.0 {
            (-from, -to)
        } else {
            (from, to)
        };
        let turn = from.cross(to).atan2(from.dot(to));
        let square = self.style.radius * self.style.radius;
        match self.style.join {
            Join::Round if corner => self.fan(p, from, turn),
            // 1 / sin(inner angle / 2) <= limit.
            Join::Miter
                if corner
                    && 2.0 * square <= (square + from.dot(to)) * self.style.miter_limit.powi(2) =>
            {
                let tip = 2.0 * square / (from + to).hypot2() * (from + to);
                self.push(vec![p, p + from, p + tip, p + to]);
            }
            _ => self.push(vec![p, p + from, p + to]),
        }
    }

    /// `left` points to the left edge of the line that leaves `p`.
    fn cap(&mut self, p: Point, left: Vec2) {
        match self.style.cap {
            Cap::Butt => {}
            Cap::Round => self.fan(p, left, std::f64::consts::PI),
            Cap::Square => {
                let back = Vec2::new(-left.y, left.x);
                self.push(vec![
                    p + left,
                    p,
                    p - left,
                    p - left + back,
                    p + left + back,
                ]);
            }
        }
    }

    /// A line without length, of which only the caps show.
    fn dot(&mut self, p: Point) {
        let right = Vec2::new(self.style.radius, 0.0);
        let up = Vec2::new(0.0, self.style.radius);
        match self.style.cap {
            Cap::Butt => {}
            Cap::Round => self.fan(p, right, std::f64::consts::TAU),
            Cap::Square => {
                self.push(vec![
                    p + right + up,
                    p - right + up,
                    p - right - up,
                    p + right - up,
                ]);
            }
        }
    }

    /// A sector of a disc around `p`, from the radius `from` on by `turn` radians.
    fn fan(&mut self, p: Point, from: Vec2, turn: f64) {
        let bits = (turn.abs() / self.angle).ceil().max(1.0);
        let mut pie = vec![p];
        let mut bit = 0.0;
        while bit <= bits {
            let (sin, cos) = (turn * bit / bits).sin_cos();
            pie.push(p + Vec2::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y));
            bit += 1.0;
        }
        self.push(pie);
    }

    fn push(&mut self, mut piece: Piece) {
        let around = piece.iter().zip(piece.iter().cycle().skip(1));
        let area: f64 = around.map(|(a, b)| a.to_vec2().cross(b.to_vec2())).sum();
        if area < 0.0 {
            piece.reverse();
        }
        self.pieces.push(piece);
    }
}
