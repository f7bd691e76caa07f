//! Which earlier items an item meets: boundaries by distance, found through buckets; insides by
//! points.

use kurbo::{Line, Point, Rect};

use crate::{
    coverage::placed::{Placed, PlacedKind},
    geometry::{clip_line, flatten, line_line_distance, pieces},
    number::floor_index,
};

/// How far flattening may move an outline, in steps. The spacing grows by twice as much, because
/// both outlines are flattened.
pub(super) const FLATTEN_TOLERANCE: f64 = 0.05;
/// Buckets along the window's longer side. A line is at most as long as a bucket.
const BUCKETS: f64 = 128.0;

/// The part of an item's boundary that lies in the window.
#[derive(Debug, Default)]
struct Boundary {
    lines: Vec<Line>,
    /// One point of each polyline.
    polyline_points: Vec<Point>,
}

/// The items so far and their ranks.
pub(super) struct Packer<'a> {
    items: &'a [Placed],
    window: Rect,
    spacing: f64,
    /// Rank of each item so far.
    pub(super) ranks: Vec<usize>,
    /// Items of each rank.
    pub(super) members: Vec<Vec<usize>>,
    polyline_points: Vec<Vec<Point>>,
    buckets: Buckets,
}

impl<'a> Packer<'a> {
    /// Before the first item. What lies outside `window` does not count, and items within `spacing`
    /// steps of each other meet.
    pub(super) fn new(items: &'a [Placed], window: Rect, spacing: f64) -> Self {
        let spacing = spacing + 2.0 * FLATTEN_TOLERANCE;
        Self {
            items,
            window,
            spacing,
            ranks: Vec::with_capacity(items.len()),
            members: Vec::new(),
            polyline_points: Vec::with_capacity(items.len()),
            buckets: Buckets::new(window, spacing),
        }
    }

    /// Ranks the next item.
    pub(super) fn add(&mut self, index: usize) {
        // A clip outline paints nothing, so it cannot meet anything.
        if self.items[index].kind == PlacedKind::Clip {
            self.polyline_points.push(Vec::new());
            self.ranks.push(0);
            return;
        }
        // Lines no longer than a bucket lie in few buckets.
        let side = self.buckets.side;
        let boundary = boundary(&self.items[index], self.window, side);
        self.polyline_points.push(boundary.polyline_points);
        // Ranks below the floor need no inside tests: the item must go above them anyway.
        let floor = self.rank_above_near(&boundary.lines);
        let rank = self.rank_above_containing(index, floor);
        // A rank that nothing had before.
        if rank == self.members.len() {
            self.members.push(Vec::new());
        }
        self.members[rank].push(index);
        self.ranks.push(rank);
        for line in boundary.lines {
            self.buckets.insert(index, line);
        }
    }

    /// The lowest rank above every earlier item whose boundary comes within the spacing of `lines`.
    fn rank_above_near(&self, lines: &[Line]) -> usize {
        let mut lowest = 0;
        for line in lines {
            let area = Rect::from_points(line.p0, line.p1).inflate(self.spacing, self.spacing);
            for bucket in self.buckets.in_box(area) {
                // Later items tend to have higher ranks. Once one of them is near, lines of lower
                // rank cannot change the result and need no distance: start with the latest.
                for &(item, other) in self.buckets.lines[bucket].iter().rev() {
                    let rank = self.ranks[item];
                    if rank >= lowest && line_line_distance(*line, other) <= self.spacing {
                        lowest = rank + 1;
                    }
                }
            }
        }
        lowest
    }

    /// The lowest rank from `floor` on above every earlier item that contains the item or is
    /// contained in it.
    fn rank_above_containing(&self, index: usize, floor: usize) -> usize {
        (floor..self.members.len())
            // Search from the top: the first rank with a containing item decides.
            .rev()
            .find(|&rank| {
                let mut members = self.members[rank].iter();
                members.any(|&member| self.one_holds_other(index, member))
            })
            .map_or(floor, |rank| rank + 1)
    }

    /// Whether two items overlap whose boundaries do not touch inside the window. Then one contains
    /// a whole polyline of the other's boundary, so one point for each polyline decides; or both
    /// fill the window, so its centre does.
    fn one_holds_other(&self, a: usize, b: usize) -> bool {
        let (item_a, item_b) = (&self.items[a], &self.items[b]);
        let common = item_a.bounds().intersect(item_b.bounds());
        if common.width() <= 0.0 || common.height() <= 0.0 {
            return false;
        }
        let holds = |outer: &Placed, polylines: &[Point]| {
            polylines.iter().any(|p| outer.region.contains(*p))
        };
        let center = self.window.center();
        holds(item_a, &self.polyline_points[b])
            || holds(item_b, &self.polyline_points[a])
            || (item_a.region.contains(center) && item_b.region.contains(center))
    }
}

fn boundary(item: &Placed, window: Rect, longest: f64) -> Boundary {
    let mut boundary = Boundary::default();
    if item.bounds().overlaps(window) {
        for contour in flatten(&item.outline, FLATTEN_TOLERANCE) {
            add_contour(&contour, window, longest, &mut boundary);
        }
    }
    boundary
}

fn add_contour(contour: &[Point], window: Rect, longest: f64, boundary: &mut Boundary) {
    let mut run_end = None;
    for ends in contour.windows(2) {
        let Some(line) = clip_line(Line::new(ends[0], ends[1]), window) else {
            run_end = None;
            continue;
        };
        // Clipping cuts the boundary into polylines. On a polyline one point speaks for all,
        // because nothing crosses it: near boundaries have been dealt with.
        if run_end != Some(line.p0) {
            boundary.polyline_points.push(line.p0);
        }
        run_end = Some(line.p1);
        boundary.lines.extend(pieces(line, longest));
    }
}

/// Lines, sorted into square buckets of the window.
struct Buckets {
    origin: Point,
    side: f64,
    columns: usize,
    rows: usize,
    /// For each bucket the lines that come into it, with their items, in painter's order.
    lines: Vec<Vec<(usize, Line)>>,
}

impl Buckets {
    fn new(window: Rect, spacing: f64) -> Self {
        // A bucket is at least as wide as the spacing, so near lines are in the same bucket or a
        // neighbour.
        let side = (window.width().max(window.height()) / BUCKETS).max(spacing);
        let columns = floor_index(window.width() / side) + 1;
        let rows = floor_index(window.height() / side) + 1;
        Self {
            origin: window.origin(),
            side,
            columns,
            rows,
            lines: vec![Vec::new(); columns * rows],
        }
    }

    fn in_box(&self, area: Rect) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        let at = |x: f64, size: usize| floor_index(x / self.side).min(size - 1);
        let (left, right) = (
            at(area.x0 - self.origin.x, columns),
            at(area.x1 - self.origin.x, columns),
        );
        let (top, bottom) = (
            at(area.y0 - self.origin.y, self.rows),
            at(area.y1 - self.origin.y, self.rows),
        );
        (top..=bottom).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
    }

    fn insert(&mut self, item: usize, line: Line) {
        for bucket in self.in_box(Rect::from_points(line.p0, line.p1)) {
            self.lines[bucket].push((item, line));
        }
    }
}
