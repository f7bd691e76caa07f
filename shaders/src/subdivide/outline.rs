//! The outline of one entry inside a part of its cell.

use vtex_format::{CURVE_HEADER_WORDS, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, CurveHeader};

/// Units by which evaluators' f32 arithmetic may misplace a lookup, with some to spare: a part
/// serves lookups this far outside it.
const SLACK_UNITS: f64 = 1.0;

/// A part of a cell's box, in units of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    /// Left and right.
    pub(super) x: [f64; 2],
    /// Top and bottom.
    pub(super) y: [f64; 2],
}

/// A line or quadratic from its upper to its lower end. A line's control point is its upper end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Segment {
    /// Upper end, control point, lower end: x in the low half, y in the high half.
    pub(super) points: [u32; 3],
    /// Whether the outline runs down along it.
    pub(super) down: bool,
    /// Whether it is straight.
    pub(super) line: bool,
}

/// What of an outline counts in a region.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Outline {
    /// Winding left of all segments at the region's top.
    pub(super) base: i32,
    /// Heights below the top at which that winding changes, ascending, and by how much.
    pub(super) changes: Vec<(u32, i32)>,
    /// Segments whose sides differ for lookups of the region.
    pub(super) segments: Vec<Segment>,
    /// Inside where the winding is odd instead of not zero.
    pub(super) even_odd: bool,
}

/// Where a segment lies as seen from a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Inside,
    Beyond,
}

impl Region {
    /// It with a border of this width.
    pub(super) fn dilated(&self, by: f64) -> Self {
        let [x, y] = [self.x, self.y].map(|[low, high]| [low - by, high + by]);
        Self { x, y }
    }

    /// What it and `other` share.
    pub(super) fn intersection(&self, other: &Self) -> Self {
        let meet = |one: [f64; 2], other: [f64; 2]| [one[0].max(other[0]), one[1].min(other[1])];
        Self {
            x: meet(self.x, other.x),
            y: meet(self.y, other.y),
        }
    }

    /// The quarters, row by row.
    pub(super) fn quarters(&self) -> [Self; 4] {
        let halves = |[low, high]: [f64; 2]| {
            let middle = 0.5 * (low + high);
            [[low, middle], [middle, high]]
        };
        let ([left, right], [top, bottom]) = (halves(self.x), halves(self.y));
        [[left, top], [right, top], [left, bottom], [right, bottom]].map(|[x, y]| Self { x, y })
    }
}

impl Segment {
    fn point(&self, index: usize) -> [f64; 2] {
        let word = self.points[index];
        [f64::from(word & 0xffff), f64::from(word >> 16)]
    }

    fn top(&self) -> u32 {
        self.points[0] >> 16
    }

    fn bottom(&self) -> u32 {
        self.points[2] >> 16
    }

    /// Where it crosses the height `y`, which its ends bracket.
    fn x_at(&self, y: f64) -> f64 {
        let [[ax, ay], [cx, cy], [bx, by]] = [self.point(0), self.point(1), self.point(2)];
        if self.line || by <= ay {
            let t = if by > ay { (y - ay) / (by - ay) } else { 0.0 };
            return ax + t * (bx - ax);
        }
        // a + 2 (c - a) t + (a - 2 c + b) t^2 = y, with the root that does not cancel: both
        // y differences are not negative because the segment is monotone.
        let (half_slope, bend) = (cy - ay, ay - 2.0 * cy + by);
        let root = (half_slope * half_slope + bend * (y - ay)).max(0.0).sqrt();
        let denominator = half_slope + root;
        let t = if denominator > 0.0 {
            (y - ay) / denominator
        } else {
            0.0
        };
        let t = t.clamp(0.0, 1.0);
        let s = 1.0 - t;
        s * s * ax + 2.0 * s * t * cx + t * t * bx
    }

    /// Which side of the box it lies on where it passes the box's heights.
    fn side(&self, region: &Region) -> Side {
        let ([left, right], [top, bottom]) = (region.x, region.y);
        let (first, last) = (f64::from(self.top()), f64::from(self.bottom()));
        if last < top || first > bottom {
            return Side::Beyond;
        }
        let [upper, lower] = [first.max(top), last.min(bottom)].map(|y| self.x_at(y));
        // Monotone, so the ends of the part span its box; a horizontal one has two ends there.
        let [from, to] = if last > first {
            [upper, lower]
        } else {
            [self.point(0)[0], self.point(2)[0]]
        };
        if from.max(to) < left {
            Side::Left
        } else if from.min(to) > right {
            Side::Beyond
        } else {
            Side::Inside
        }
    }
}

impl Outline {
    /// The record at the start of `words`; `None` when it is not one.
    pub(super) fn decode(words: &[u32]) -> Option<Self> {
        let (head, rest) = words.split_at_checked(CURVE_HEADER_WORDS as usize)?;
        let header = CurveHeader::decode([head[0], head[1]])?;
        let (steps, rest) = rest.split_at_checked(header.step_count as usize)?;
        let lines = (header.line_count * CURVE_LINE_WORDS) as usize;
        let (lines, rest) = rest.split_at_checked(lines)?;
        let quads = rest.get(..(header.quad_count * CURVE_QUAD_WORDS) as usize)?;
        let lines = lines.as_chunks::<2>().0.iter().zip(0..);
        let quads = quads.as_chunks::<3>().0.iter().zip(0..);
        let lines = lines.map(|(&[a, b], index)| Segment {
            points: [a, a, b],
            down: index < header.down_line_count,
            line: true,
        });
        let quads = quads.map(|(&points, index)| Segment {
            points,
            down: index < header.down_quad_count,
            line: false,
        });
        let change = |&step: &u32| (step & 0xffff, step.cast_signed() >> 16);
        let mut outline = Self {
            base: header.base_winding,
            changes: steps.iter().map(change).collect(),
            segments: lines.chain(quads).collect(),
            even_odd: header.even_odd,
        };
        outline.changes.sort_unstable();
        Some(outline)
    }

    /// What of it counts in `region`, a part of the region it is for.
    pub(super) fn within(&self, region: &Region) -> Self {
        let near = region.dilated(SLACK_UNITS);
        let mut inner = Self {
            base: self.base,
            changes: self.changes.clone(),
            segments: Vec::new(),
            even_odd: self.even_odd,
        };
        for segment in &self.segments {
            let crosses = segment.bottom() > segment.top();
            // A horizontal one changes no winding.
            if !crosses {
                continue;
            }
            let side = segment.side(&near);
            if side == Side::Inside {
                inner.segments.push(*segment);
            } else if side == Side::Left {
                let change = if segment.down { 1 } else { -1 };
                inner.changes.push((segment.top(), change));
                inner.changes.push((segment.bottom(), -change));
            }
        }
        inner.fold_changes(near.y);
        inner
    }

    /// Changes above the heights go into the base, those below vanish, equal ones come together.
    fn fold_changes(&mut self, [top, bottom]: [f64; 2]) {
        self.changes.sort_unstable();
        let mut kept: Vec<(u32, i32)> = Vec::new();
        for &(height, change) in &self.changes {
            if f64::from(height) <= top {
                self.base += change;
            } else if f64::from(height) <= bottom {
                match kept.last_mut() {
                    Some(last) if last.0 == height => last.1 += change,
                    _ => kept.push((height, change)),
                }
            }
        }
        kept.retain(|change| change.1 != 0);
        self.changes = kept;
    }

    /// Commands that it takes at least.
    pub(super) fn command_count(&self) -> usize {
        (self.segments.len() + self.changes.len()).max(1)
    }

    /// Whether no lookup of the region meets an edge.
    pub(super) fn is_uniform(&self) -> bool {
        self.segments.is_empty() && self.changes.is_empty()
    }

    /// Whether the base alone fills.
    pub(super) fn base_fills(&self) -> bool {
        if self.even_odd {
            self.base & 1 != 0
        } else {
            self.base != 0
        }
    }
}
