//! Winding numbers of Bezier outlines, watertight: every point of the plane gets the winding of an
//! outline that differs from the true one by rounding alone.
//!
//! Segments are cut at their extrema in y, so that each piece is monotone in y. A piece meets the
//! horizontal line through `y` if `y_min <= y < y_max`. This rule is half open, and pieces that
//! follow each other share the bit-exact y: a line through their common point meets exactly one of
//! them where the outline goes on, and both or neither where it turns. So no rounding can lose or
//! double a crossing; it can only move one along the line.

use kurbo::{BezPath, ParamCurve, PathSeg, Point, Rect};

use super::segment::{control_box, set_end, set_start};
use crate::{
    drawing::FillRule,
    number::{count, floor_index},
};

/// Most rows that a [`Region`] sorts its pieces into: bounds the memory.
const MAX_ROWS: f64 = 4096.0;

/// A piece of a segment along which y only grows or only falls.
#[derive(Clone, Copy, Debug)]
struct Monotone {
    curve: PathSeg,
    y_min: f64,
    y_max: f64,
    x_min: f64,
    x_max: f64,
    /// +1 where the outline runs towards growing y, -1 where it runs back.
    direction: i32,
}

impl Monotone {
    fn crosses(&self, y: f64) -> bool {
        self.y_min <= y && y < self.y_max
    }

    /// Where the piece meets the horizontal line through `y`; [`Self::crosses`] must hold.
    fn x_at(&self, y: f64) -> f64 {
        let x = match self.curve {
            PathSeg::Line(l) => l.p0.x + (y - l.p0.y) / (l.p1.y - l.p0.y) * (l.p1.x - l.p0.x),
            PathSeg::Quad(q) => {
                let c = power_basis([q.p0, q.p1, q.p1, q.p2], 2);
                evaluate(c.0, self.parameter_at(c.1, y))
            }
            PathSeg::Cubic(k) => {
                let c = power_basis([k.p0, k.p1, k.p2, k.p3], 3);
                evaluate(c.0, self.parameter_at(c.1, y))
            }
        };
        x.clamp(self.x_min, self.x_max)
    }

    /// The parameter at height `y`: Newton's method, kept inside a bracket that shrinks. A step
    /// that leaves the bracket becomes a bisection, so the loop converges for any cubic.
    fn parameter_at(&self, c: [f64; 4], y: f64) -> f64 {
        // With the sign of the direction the function always grows with t.
        let sign = f64::from(self.direction);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        // Start where a straight piece would be.
        let mut t = (y - self.y_min) / (self.y_max - self.y_min);
        if self.direction < 0 {
            t = 1.0 - t;
        }
        for _ in 0..64 {
            let error = sign * (evaluate(c, t) - y);
            if error == 0.0 {
                break;
            }
            if error > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let slope = sign * (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]));
            let mut next = t - error / slope;
            if !(next > low && next < high) {
                next = 0.5 * (low + high);
            }
            // Closer than f64 can tell parameters near 1 apart.
            if (next - t).abs() < 1e-16 {
                break;
            }
            t = next;
        }
        t
    }
}

/// Coefficients of `1, t, t^2, t^3` for x and for y.
fn power_basis(p: [Point; 4], degree: u32) -> ([f64; 4], [f64; 4]) {
    let of = |a: f64, b: f64, c: f64, d: f64| {
        // Callers pass the control point of a quadratic twice; the second copy is not used.
        if degree == 2 {
            [a, 2.0 * (b - a), a - 2.0 * b + d, 0.0]
        } else {
            [
                a,
                3.0 * (b - a),
                3.0 * (a - 2.0 * b + c),
                d - a + 3.0 * (b - c),
            ]
        }
    };
    let [a, b, c, d] = p;
    (of(a.x, b.x, c.x, d.x), of(a.y, b.y, c.y, d.y))
}

fn evaluate(c: [f64; 4], t: f64) -> f64 {
    c[0] + t * (c[1] + t * (c[2] + t * c[3]))
}

/// A filled outline that answers inside tests. Pieces are sorted into rows by y, so a test looks at
/// few of them.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    pieces: Vec<Monotone>,
    rule: FillRule,
    /// Box of the control points.
    bounds: Rect,
    rows_per_unit: f64,
    /// Pieces `row_pieces[row_first[r]..row_first[r + 1]]` reach into row `r`.
    row_first: Vec<usize>,
    row_pieces: Vec<usize>,
}

impl Region {
    /// A region of closed contours.
    pub(crate) fn new(outline: &BezPath, rule: FillRule) -> Self {
        let pieces: Vec<Monotone> = outline.segments().flat_map(monotone_pieces).collect();
        let bounds = outline.control_box();
        let height = bounds.height().max(f64::MIN_POSITIVE);
        // Aims at four rows for each piece on average: few rows where pieces are tall, many where
        // they are short. So memory stays proportional to the outline.
        let heights: f64 = pieces.iter().map(|p| (p.y_max - p.y_min) / height).sum();
        let rows = (4.0 * count(pieces.len()) / heights.max(1.0)).clamp(1.0, MAX_ROWS);
        let mut region = Self {
            pieces,
            rule,
            bounds,
            rows_per_unit: rows.floor() / height,
            row_first: Vec::new(),
            row_pieces: Vec::new(),
        };
        region.sort_into_rows(floor_index(rows));
        region
    }

    fn sort_into_rows(&mut self, rows: usize) {
        let spans: Vec<(usize, usize)> = self
            .pieces
            .iter()
            .map(|p| (self.row_of(p.y_min, rows), self.row_of(p.y_max, rows)))
            .collect();
        let mut first = vec![0; rows + 1];
        for &(top, bottom) in &spans {
            for row in top..=bottom {
                first[row + 1] += 1;
            }
        }
        // Counting sort: counts become the first place of each row.
        for row in 0..rows {
            first[row + 1] += first[row];
        }
        let mut next = first.clone();
        self.row_pieces = vec![0; first[rows]];
        for (piece, &(top, bottom)) in spans.iter().enumerate() {
            for slot in &mut next[top..=bottom] {
                self.row_pieces[*slot] = piece;
                *slot += 1;
            }
        }
        self.row_first = first;
    }

    fn row_of(&self, y: f64, rows: usize) -> usize {
        floor_index((y - self.bounds.y0) * self.rows_per_unit).min(rows - 1)
    }

    fn pieces_at(&self, y: f64) -> impl Iterator<Item = &Monotone> {
        let rows = self.row_first.len() - 1;
        // Beyond the box `row_of` would still name a row.
        let inside = y >= self.bounds.y0 && y <= self.bounds.y1;
        let row = self.row_of(y, rows);
        let range = if inside {
            self.row_first[row]..self.row_first[row + 1]
        } else {
            0..0
        };
        self.row_pieces[range]
            .iter()
            .map(|&piece| &self.pieces[piece])
            .filter(move |piece| piece.crosses(y))
    }

    /// Box of the outline's control points.
    pub(crate) fn bounds(&self) -> Rect {
        self.bounds
    }

    /// The winding number of `p`. A contour of positive area winds +1 around its inside.
    pub(crate) fn winding(&self, p: Point) -> i32 {
        self.pieces_at(p.y)
            // Only pieces at or to the left of `p` count. The boxes decide most of them.
            .filter(|piece| p.x >= piece.x_max || (p.x >= piece.x_min && p.x >= piece.x_at(p.y)))
            // To the left of the inside of a positive contour the outline runs towards smaller y.
            .map(|piece| -piece.direction)
            .sum()
    }

    /// Whether `p` is filled.
    pub(crate) fn contains(&self, p: Point) -> bool {
        self.rule.fills(self.winding(p))
    }

    /// Crossings of the horizontal line through `y`: x, and the winding to the right of it. Sorted.
    pub(crate) fn crossings(&self, y: f64) -> Vec<(f64, i32)> {
        let mut row: Vec<(f64, i32)> = self
            .pieces_at(y)
            .map(|piece| (piece.x_at(y), -piece.direction))
            .collect();
        row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for crossing in &mut row {
            winding += crossing.1;
            crossing.1 = winding;
        }
        row
    }

    /// Whether the point at `x` on the line that has these `crossings` is filled.
    pub(crate) fn fills_row(&self, crossings: &[(f64, i32)], x: f64) -> bool {
        // A crossing at x itself counts as left of the point, as in `winding`.
        let right = crossings.partition_point(|crossing| crossing.0 <= x);
        right > 0 && self.rule.fills(crossings[right - 1].1)
    }
}

/// Cuts `segment` at its extrema in y. Horizontal pieces cross no line and are left out.
fn monotone_pieces(segment: PathSeg) -> Vec<Monotone> {
    let mut cuts = vec![0.0];
    cuts.extend(y_extrema(&segment));
    cuts.push(1.0);
    let mut from = segment.start();
    let mut pieces = Vec::with_capacity(cuts.len() - 1);
    for pair in cuts.windows(2) {
        let whole = pair[0] == 0.0 && pair[1] == 1.0;
        let mut curve = if whole {
            segment
        } else {
            segment.subsegment(pair[0]..pair[1])
        };
        // The end of the segment is taken as it is: evaluating the curve there may round.
        let to = if pair[1] == 1.0 {
            segment.end()
        } else {
            curve.end()
        };
        // Invariant: consecutive pieces share the bit-exact point.
        set_start(&mut curve, from);
        set_end(&mut curve, to);
        pieces.extend(monotone(curve));
        from = to;
    }
    pieces
}

fn monotone(curve: PathSeg) -> Option<Monotone> {
    let (y0, y1) = (curve.start().y, curve.end().y);
    // Of no height: it meets no line by the half-open rule.
    if y0 == y1 {
        return None;
    }
    let control = control_box(&curve);
    Some(Monotone {
        curve,
        y_min: y0.min(y1),
        y_max: y0.max(y1),
        x_min: control.x0,
        x_max: control.x1,
        direction: if y1 > y0 { 1 } else { -1 },
    })
}

/// Parameters in (0, 1) at which y has an extremum, ascending.
fn y_extrema(segment: &PathSeg) -> Vec<f64> {
    let mut roots: Vec<f64> = match segment {
        PathSeg::Line(_) => Vec::new(),
        PathSeg::Quad(q) => {
            let (a, b) = (q.p1.y - q.p0.y, q.p2.y - q.p1.y);
            // Infinite or NaN for a quadratic that is straight in y; filtered below.
            vec![a / (a - b)]
        }
        PathSeg::Cubic(c) => {
            let d = [c.p1.y - c.p0.y, c.p2.y - c.p1.y, c.p3.y - c.p2.y];
            kurbo::common::solve_quadratic(d[0], 2.0 * (d[1] - d[0]), d[0] - 2.0 * d[1] + d[2])
                .to_vec()
        }
    };
    roots.retain(|t| *t > 0.0 && *t < 1.0);
    roots.sort_unstable_by(f64::total_cmp);
    roots.dedup();
    roots
}
