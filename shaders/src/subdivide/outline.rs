//! The outline of one entry inside a part of its cell.

use std::ops::Range;

use vtex_format::{CURVE_HEADER_WORDS, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, CurveHeader};

use super::hash;
use crate::layout::{FilterMode, cell, cmd};

/// Units by which evaluators' f32 arithmetic may misplace a lookup, with some to spare: a part
/// serves lookups this far outside it.
const SLACK_UNITS: f64 = 1.0;
/// The extent of a segment that no lookup of a region can tell from none.
const NOWHERE: [f64; 2] = [f64::INFINITY; 2];

/// A part of a cell's box, in units of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    /// Left and right.
    pub(super) x: [f64; 2],
    /// Top and bottom.
    pub(super) y: [f64; 2],
}

/// A line or quadratic from its upper to its lower end, as evaluators' command: upper end, control
/// point, lower end, each with x in the low half and y in the high half, and what it is. A line's
/// control point is its upper end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Segment(pub(super) [u32; 4]);

/// A range of an arena.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Span {
    first: u32,
    end: u32,
}

/// What of an outline counts in a region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Outline {
    /// Winding left of all segments at the region's top.
    pub(super) base: i32,
    /// Inside where the winding is odd instead of not zero.
    pub(super) even_odd: bool,
    /// Heights below the top at which that winding changes, ascending, and by how much.
    changes: Span,
    /// Places of the segments whose sides differ for lookups of the region.
    places: Span,
    /// Of those segments.
    hash: u64,
}

/// What the outlines of a cell of the file and of its parts are made of. Its memory serves the next
/// cell again.
#[derive(Clone, Debug, Default)]
pub(super) struct Outlines {
    /// Those of the whole cell, and a hash of each.
    segments: Vec<(Segment, u64)>,
    /// For each segment of each outline, which it is.
    places: Vec<u32>,
    changes: Vec<(u32, i32)>,
    trace: Trace,
}

/// Where segments lie between two heights.
#[derive(Clone, Debug, Default)]
struct Trace {
    /// The first one's place.
    first: u32,
    /// Top and bottom.
    y: [f64; 2],
    /// For each segment the least and the greatest x.
    x: Vec<[f64; 2]>,
}

/// What the list of a fine cell serves, where `whole` is a cell of the file.
pub(super) fn dilated(fine: &Region, whole: &Region, filter: FilterMode) -> Region {
    if filter == FilterMode::Footprint {
        let side = fine.x[1] - fine.x[0];
        fine.dilated(side * f64::from(cell::OVERLAP) / 16.0)
            .intersection(whole)
    } else {
        *fine
    }
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
    pub(super) fn quarters(&self) -> [[Self; 2]; 2] {
        let halves = |[low, high]: [f64; 2]| {
            let middle = 0.5 * (low + high);
            [[low, middle], [middle, high]]
        };
        let columns = halves(self.x);
        halves(self.y).map(|y| columns.map(|x| Self { x, y }))
    }
}

impl Segment {
    pub(super) fn new([upper, control, lower]: [u32; 3], down: bool, line: bool) -> Self {
        let down = if down { cmd::DOWN_BIT } else { 0 };
        let line = if line { cmd::LINE_BIT } else { 0 };
        Self([upper, control, lower, down | line])
    }

    fn point(&self, index: usize) -> [f64; 2] {
        let word = self.0[index];
        [f64::from(word & 0xffff), f64::from(word >> 16)]
    }

    fn top(&self) -> u32 {
        self.0[0] >> 16
    }

    fn bottom(&self) -> u32 {
        self.0[2] >> 16
    }

    /// By how much the winding right of it differs from that left of it.
    fn change(&self) -> i32 {
        if self.0[3] & cmd::DOWN_BIT != 0 {
            1
        } else {
            -1
        }
    }

    /// Where it crosses the height `y`, which its ends bracket.
    fn x_at(&self, y: f64) -> f64 {
        let [[ax, ay], [cx, cy], [bx, by]] = [self.point(0), self.point(1), self.point(2)];
        if self.0[3] & cmd::LINE_BIT != 0 || by <= ay {
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

    /// The least and the greatest x between two heights; `None` where it passes neither them nor
    /// what lies between.
    fn extent(&self, [top, bottom]: [f64; 2]) -> Option<[f64; 2]> {
        let (first, last) = (f64::from(self.top()), f64::from(self.bottom()));
        // A horizontal one changes no winding.
        if last <= first || last < top || first > bottom {
            return None;
        }
        // Monotone, so the ends of the part span its box.
        let from = if first < top {
            self.x_at(top)
        } else {
            self.point(0)[0]
        };
        let to = if last > bottom {
            self.x_at(bottom)
        } else {
            self.point(2)[0]
        };
        Some([from.min(to), from.max(to)])
    }
}

impl Span {
    /// The end of an arena from its element `first` on.
    pub(super) fn from<T>(first: usize, arena: &[T]) -> Self {
        let index = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Self {
            first: index(first),
            end: index(arena.len()),
        }
    }

    pub(super) fn range(self) -> Range<usize> {
        self.first as usize..self.end as usize
    }

    pub(super) fn is_empty(self) -> bool {
        self.first >= self.end
    }
}

impl Outlines {
    pub(super) fn clear(&mut self) {
        self.segments.clear();
        self.places.clear();
        self.changes.clear();
    }

    /// The record at the start of `words`; `None` when it is not one.
    pub(super) fn decode(&mut self, words: &[u32]) -> Option<Outline> {
        let (head, rest) = words.split_at_checked(CURVE_HEADER_WORDS as usize)?;
        let header = CurveHeader::decode([head[0], head[1]])?;
        let (steps, rest) = rest.split_at_checked(header.step_count as usize)?;
        let lines = (header.line_count * CURVE_LINE_WORDS) as usize;
        let (lines, rest) = rest.split_at_checked(lines)?;
        let quads = rest.get(..(header.quad_count * CURVE_QUAD_WORDS) as usize)?;
        let lines = lines.as_chunks::<2>().0.iter().zip(0..);
        let quads = quads.as_chunks::<3>().0.iter().zip(0..);
        let lines = lines.map(|(&[a, b], index)| {
            let down = index < header.down_line_count;
            Segment::new([a, a, b], down, true)
        });
        let quads = quads.map(|(&points, index)| {
            let down = index < header.down_quad_count;
            Segment::new(points, down, false)
        });
        let (first, place) = (self.changes.len(), self.places.len());
        let change = |&step: &u32| (step & 0xffff, step.cast_signed() >> 16);
        self.changes.extend(steps.iter().map(change));
        self.changes[first..].sort_unstable();
        let mut all = hash::START;
        for segment in lines.chain(quads) {
            let index = self.segments.len();
            self.places.push(u32::try_from(index).unwrap_or(u32::MAX));
            let hash = hash::of(segment.0);
            self.segments.push((segment, hash));
            all = hash::mix(all, hash);
        }
        Some(Outline {
            base: header.base_winding,
            even_odd: header.even_odd,
            changes: Span::from(first, &self.changes),
            places: Span::from(place, &self.places),
            hash: all,
        })
    }

    /// How many segments all outlines so far have.
    pub(super) fn place_count(&self) -> usize {
        self.places.len()
    }

    /// All segments from place `first` on.
    pub(super) fn places_from(&self, first: usize) -> Span {
        Span::from(first, &self.places)
    }

    /// Prepares [`Self::within`] for outlines with segments at `places` and regions of these heights.
    pub(super) fn trace(&mut self, places: Span, y: [f64; 2]) {
        self.trace.first = places.first;
        self.trace.y = [y[0] - SLACK_UNITS, y[1] + SLACK_UNITS];
        self.trace.x.clear();
        let (segments, y) = (&self.segments, self.trace.y);
        let places = &self.places[places.range()];
        let extents = places
            .iter()
            .map(|&place| segments[place as usize].0.extent(y).unwrap_or(NOWHERE));
        self.trace.x.extend(extents);
    }

    /// What of an outline counts between two x, within the heights of [`Self::trace`].
    pub(super) fn within(&mut self, outline: Outline, x: [f64; 2]) -> Outline {
        let [left, right] = [x[0] - SLACK_UNITS, x[1] + SLACK_UNITS];
        let (change, place) = (self.changes.len(), self.places.len());
        let mut base = outline.base;
        for at in outline.changes.range() {
            base += self.change(self.changes[at]);
        }
        let mut hash = hash::START;
        for at in outline.places.range() {
            let [least, greatest] = self.trace.x[at - self.trace.first as usize];
            if greatest < left {
                let (segment, _) = self.segments[self.places[at] as usize];
                let change = segment.change();
                base += self.change((segment.top(), change));
                base += self.change((segment.bottom(), -change));
            } else if least <= right {
                let place = self.places[at];
                self.places.push(place);
                hash = hash::mix(hash, self.segments[place as usize].1);
            }
        }
        self.join_changes(change);
        Outline {
            base,
            even_odd: outline.even_odd,
            changes: Span::from(change, &self.changes),
            places: Span::from(place, &self.places),
            hash,
        }
    }

    /// A change above the heights of the trace goes into the base, whose growth comes back; one
    /// below them vanishes.
    fn change(&mut self, (height, change): (u32, i32)) -> i32 {
        let [top, bottom] = self.trace.y;
        if f64::from(height) <= top {
            return change;
        }
        if f64::from(height) <= bottom {
            self.changes.push((height, change));
        }
        0
    }

    /// Changes from `first` on in ascending order, those at one height as one.
    fn join_changes(&mut self, first: usize) {
        if self.changes.len() == first {
            return;
        }
        self.changes[first..].sort_unstable();
        let mut end = first;
        for at in first..self.changes.len() {
            let (height, change) = self.changes[at];
            match self.changes[first..end].last_mut() {
                Some(last) if last.0 == height => last.1 += change,
                Some(last) if last.1 == 0 => *last = (height, change),
                _ => {
                    self.changes[end] = (height, change);
                    end += 1;
                }
            }
        }
        if self.changes[end - 1].1 == 0 {
            end -= 1;
        }
        self.changes.truncate(end);
    }

    pub(super) fn changes(&self, outline: &Outline) -> &[(u32, i32)] {
        &self.changes[outline.changes.range()]
    }

    pub(super) fn segments(&self, outline: &Outline) -> impl Iterator<Item = &Segment> {
        let places = &self.places[outline.places.range()];
        let segment = |&place: &u32| &self.segments[place as usize].0;
        places.iter().map(segment)
    }
}

impl Outline {
    /// How many segments it has, and their hash.
    pub(super) fn summary(&self) -> (usize, u64) {
        (self.places.range().len(), self.hash)
    }

    /// Whether no lookup of the region meets an edge.
    pub(super) fn is_uniform(&self) -> bool {
        self.places.is_empty() && self.changes.is_empty()
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
