//! Greedy order-preserving packing into subsets whose members never meet.
//!
//! Item i gets the lowest rank above every earlier item that meets it; two items meet when their
//! filled regions, as seen inside a window, come within a reach of each other. By construction
//! members of a rank do not meet, painter's order is kept wherever it shows, and the number of
//! ranks is the length of the longest chain of items each of which meets the next.

use kurbo::{Line, Point, Rect};

use crate::{
    coverage::placed::{Placed, PlacedKind},
    geometry::{clip_line, flatten, floor_index, line_line_distance},
};

/// How far flattening may move an outline, in steps; the reach grows by both outlines' share.
const FLATTEN_TOLERANCE: f64 = 0.05;
/// Buckets along the window's longer side; a line is as long as a bucket at most.
const BUCKETS: f64 = 128.0;

/// Ranks of items in painter's order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Packing {
    /// Rank of each item; the backmost is 0.
    pub(crate) ranks: Vec<u32>,
    /// How many ranks there are.
    pub(crate) count: u32,
    /// Whether some items met though all were to share one rank.
    pub(crate) forced: bool,
}

/// The part of an item's boundary that lies in the window.
#[derive(Debug, Default)]
struct Boundary {
    lines: Vec<Line>,
    /// One point of every connected run of lines.
    run_points: Vec<Point>,
}

/// Packs `items`. What lies outside `window` does not count, two items within `reach` steps do.
pub(crate) fn pack(items: &[Placed], window: Rect, reach: f64) -> Packing {
    let mut packer = Packer::new(items, window, reach);
    for index in 0..items.len() {
        packer.add(index);
    }
    Packing {
        count: ranks_to_u32(packer.members.len()),
        ranks: packer
            .ranks
            .iter()
            .map(|&rank| ranks_to_u32(rank))
            .collect(),
        forced: false,
    }
}

/// \[SFG22\]'s "merge all": every item in rank 0, whatever they touch.
pub(crate) fn merge_all(items: &[Placed], window: Rect, reach: f64) -> Packing {
    Packing {
        ranks: vec![0; items.len()],
        count: u32::from(!items.is_empty()),
        forced: pack(items, window, reach).count > 1,
    }
}

struct Packer<'a> {
    items: &'a [Placed],
    window: Rect,
    reach: f64,
    ranks: Vec<usize>,
    /// Items of each rank.
    members: Vec<Vec<usize>>,
    run_points: Vec<Vec<Point>>,
    buckets: Buckets,
}

impl<'a> Packer<'a> {
    fn new(items: &'a [Placed], window: Rect, reach: f64) -> Self {
        let reach = reach + 2.0 * FLATTEN_TOLERANCE;
        Self {
            items,
            window,
            reach,
            ranks: Vec::with_capacity(items.len()),
            members: Vec::new(),
            run_points: Vec::with_capacity(items.len()),
            buckets: Buckets::new(window, reach),
        }
    }

    fn add(&mut self, index: usize) {
        // What is not painted is in nobody's way.
        if self.items[index].kind == PlacedKind::Clip {
            self.run_points.push(Vec::new());
            self.ranks.push(0);
            return;
        }
        let side = self.buckets.side;
        let boundary = boundary(&self.items[index], self.window, side);
        self.run_points.push(boundary.run_points);
        let floor = self.rank_above_near(&boundary.lines);
        let rank = self.rank_above_containing(index, floor);
        if rank == self.members.len() {
            self.members.push(Vec::new());
        }
        self.members[rank].push(index);
        self.ranks.push(rank);
        for line in boundary.lines {
            self.buckets.insert(index, line);
        }
    }

    /// The lowest rank above every earlier item whose boundary comes within reach of `lines`.
    fn rank_above_near(&self, lines: &[Line]) -> usize {
        let mut lowest = 0;
        for line in lines {
            let area = Rect::from_points(line.p0, line.p1).inflate(self.reach, self.reach);
            for bucket in self.buckets.in_box(area) {
                // Later items tend to have higher ranks, after which the others need no distance.
                for &(item, other) in self.buckets.lines[bucket].iter().rev() {
                    let rank = self.ranks[item];
                    if rank >= lowest && line_line_distance(*line, other) <= self.reach {
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
            .rev()
            .find(|&rank| {
                let mut members = self.members[rank].iter();
                members.any(|&member| self.one_holds_other(index, member))
            })
            .map_or(floor, |rank| rank + 1)
    }

    /// For two items whose boundaries inside the window do not touch: whether they overlap. Then a
    /// whole run of one's boundary lies in the other, or both fill the window.
    fn one_holds_other(&self, a: usize, b: usize) -> bool {
        let (item_a, item_b) = (&self.items[a], &self.items[b]);
        let common = item_a.bounds().intersect(item_b.bounds());
        if common.width() <= 0.0 || common.height() <= 0.0 {
            return false;
        }
        let holds = |outer: &Placed, runs: &[Point]| runs.iter().any(|p| outer.region.contains(*p));
        let center = self.window.center();
        holds(item_a, &self.run_points[b])
            || holds(item_b, &self.run_points[a])
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
        if run_end != Some(line.p0) {
            boundary.run_points.push(line.p0);
        }
        run_end = Some(line.p1);
        let pieces = ((line.p1 - line.p0).hypot() / longest).ceil().max(1.0);
        let mut from = line.p0;
        for k in 1..=floor_index(pieces) {
            #[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
            let to = line.p0.lerp(line.p1, k as f64 / pieces);
            boundary.lines.push(Line::new(from, to));
            from = to;
        }
    }
}

/// Lines by where they lie.
struct Buckets {
    origin: Point,
    side: f64,
    columns: usize,
    rows: usize,
    /// Item and line, in painter's order.
    lines: Vec<Vec<(usize, Line)>>,
}

impl Buckets {
    fn new(window: Rect, reach: f64) -> Self {
        let side = (window.width().max(window.height()) / BUCKETS).max(reach);
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

fn ranks_to_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use kurbo::{Line, Point, Rect};
    use vtex_testing::Corpus;

    use super::{FLATTEN_TOLERANCE, Packing, merge_all, pack};
    use crate::{
        config::BakeConfig,
        coverage::{
            grid::Lattice,
            placed::{Placed, PlacedKind, place},
        },
        drawing::FillRule,
        geometry::{flatten, line_line_distance},
        testing::{Random, drawing_of, random_outline},
    };

    const WINDOW: Rect = Rect::new(-50.0, -50.0, 250.0, 250.0);

    fn random_items(random: &mut Random, count: usize, size: f64) -> Vec<Placed> {
        (0..count)
            .map(|_| {
                let rule = match random.below(2) {
                    0 => FillRule::NonZero,
                    _ => FillRule::EvenOdd,
                };
                Placed::new(random_outline(random, size), rule, PlacedKind::Patch)
            })
            .collect()
    }

    fn lines(item: &Placed) -> Vec<Line> {
        flatten(&item.outline, FLATTEN_TOLERANCE)
            .iter()
            .flat_map(|contour| contour.windows(2).map(|ends| Line::new(ends[0], ends[1])))
            .collect()
    }

    /// Every line against every line, every vertex against the other's inside.
    fn meet(a: &Placed, b: &Placed, reach: f64) -> bool {
        let apart = |a: Rect, b: Rect| !a.inflate(reach, reach).overlaps(b);
        if apart(a.bounds(), b.bounds()) {
            return false;
        }
        let (lines_a, lines_b) = (lines(a), lines(b));
        let close = lines_a
            .iter()
            .any(|x| lines_b.iter().any(|y| line_line_distance(*x, *y) <= reach));
        close
            || lines_a.iter().any(|line| b.region.contains(line.p0))
            || lines_b.iter().any(|line| a.region.contains(line.p0))
    }

    fn check(items: &[Placed], packing: &Packing, reach: f64) {
        let exact_reach = reach + 2.0 * FLATTEN_TOLERANCE;
        let mut chain = vec![0; items.len()];
        for i in 0..items.len() {
            for j in 0..i {
                if meet(&items[i], &items[j], exact_reach) {
                    assert!(packing.ranks[j] < packing.ranks[i], "{j} and {i} meet");
                    chain[i] = chain[i].max(chain[j] + 1);
                }
            }
        }
        // Greedy ranks are longest chains, so the count is the longest of all.
        assert_eq!(packing.ranks, chain);
        let longest = chain.iter().max().map_or(0, |rank| rank + 1);
        assert_eq!(packing.count, longest);
    }

    #[test]
    fn ranks_are_the_longest_chains_of_shapes_that_meet() {
        let mut random = Random(11);
        for round in 0..30 {
            let size = [60.0, 200.0, 200.0][round % 3];
            let items = random_items(&mut random, 40, size);
            let reach = random.within(0.5, 8.0);
            check(&items, &pack(&items, WINDOW, reach), reach);
        }
    }

    #[test]
    fn members_of_a_rank_keep_their_distance_at_every_point() {
        let mut random = Random(12);
        let items = random_items(&mut random, 60, 200.0);
        let packing = pack(&items, WINDOW, 4.0);
        for (i, a) in items.iter().enumerate() {
            for (j, b) in items.iter().enumerate().take(i) {
                if packing.ranks[i] != packing.ranks[j] {
                    continue;
                }
                // Points of the true curves, not of their flattening.
                let of = |item: &Placed| -> Vec<Point> {
                    let segments = item.outline.segments();
                    let at = |k: u32| f64::from(k) / 8.0;
                    segments
                        .flat_map(|s| (0..8).map(move |k| kurbo::ParamCurve::eval(&s, at(k))))
                        .collect()
                };
                for p in of(a) {
                    assert!(!b.region.contains(p), "{i} {j}");
                    assert!(of(b).iter().all(|q| (*q - p).hypot() > 4.0), "{i} {j}");
                }
            }
        }
    }

    #[test]
    fn shapes_that_fill_the_window_and_shapes_beside_it() {
        let square = |low: f64, high: f64| {
            let path = kurbo::Shape::to_path(&Rect::new(low, low, high, high), 0.1);
            Placed::new(path, FillRule::NonZero, PlacedKind::Patch)
        };
        // Two grounds larger than the window, a dot, and something far outside.
        let items = [
            square(-1e4, 1e4),
            square(-2e4, 2e4),
            square(10.0, 20.0),
            square(1e3, 2e3),
        ];
        assert_eq!(pack(&items, WINDOW, 1.0).ranks, [0, 1, 2, 0]);
        let merged = merge_all(&items, WINDOW, 1.0);
        assert!(merged.forced && merged.ranks == [0; 4]);
        assert!(!merge_all(&items[2..], WINDOW, 1.0).forced);
    }

    fn check_svg(svg: &[u8]) {
        let everywhere = Rect::new(-1e7, -1e7, 1e7, 1e7);
        let config = BakeConfig::default();
        let drawing = drawing_of(svg, &config);
        let lattice = Lattice::new(drawing.canvas_size, config.msdf_size);
        let forced =
            crate::coverage::judge::Verdict::forced(crate::coverage::judge::Coverage::Msdf);
        let mut items = place(&drawing, &lattice, &vec![forced; drawing.items.len()]);
        items.retain(|item| item.kind != PlacedKind::Clip);
        let reach = f64::from(config.distance_range_texels);
        check(&items, &pack(&items, everywhere, reach), reach);
    }

    /// Disjoint and in order on real drawings, and as few layers as the longest chain allows.
    #[test]
    fn corpus_ranks_are_the_longest_chains() {
        let Some(corpus) = Corpus::find("layers of real drawings") else {
            return;
        };
        check_svg(&corpus.read("paper5/5_tiger__svgpan__tiger.svg"));
        // Brute force takes every pair of lines: small files, and of every kind some.
        let mut names = corpus.drawings();
        names.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
        names.retain(|path| path.metadata().is_ok_and(|file| file.len() <= 16 << 10));
        for path in names.iter().step_by(2) {
            check_svg(&std::fs::read(path).unwrap());
        }
    }
}
