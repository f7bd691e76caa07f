//! Ranks against brute force.

use kurbo::{Line, Point, Rect};
use vtex_testing::Corpus;

use super::{Packing, merge_all, pack, packer::FLATTEN_TOLERANCE};
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
            Placed::new(random_outline(random, size), rule, PlacedKind::Image)
        })
        .collect()
}

fn lines(item: &Placed) -> Vec<Line> {
    flatten(&item.outline, FLATTEN_TOLERANCE)
        .iter()
        .flat_map(|contour| contour.windows(2).map(|ends| Line::new(ends[0], ends[1])))
        .collect()
}

/// Whether two items meet: every line against every line, every vertex against the other's inside.
fn meet(a: &Placed, b: &Placed, spacing: f64) -> bool {
    let apart = |a: Rect, b: Rect| !a.inflate(spacing, spacing).overlaps(b);
    if apart(a.bounds(), b.bounds()) {
        return false;
    }
    let (lines_a, lines_b) = (lines(a), lines(b));
    let close = lines_a.iter().any(|x| {
        lines_b
            .iter()
            .any(|y| line_line_distance(*x, *y) <= spacing)
    });
    close
        || lines_a.iter().any(|line| b.region.contains(line.p0))
        || lines_b.iter().any(|line| a.region.contains(line.p0))
}

fn check(items: &[Placed], packing: &Packing, spacing: f64) {
    let exact_spacing = spacing + 2.0 * FLATTEN_TOLERANCE;
    let mut chain = vec![0; items.len()];
    for i in 0..items.len() {
        for j in 0..i {
            if meet(&items[i], &items[j], exact_spacing) {
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
        let spacing = random.within(0.5, 8.0);
        check(&items, &pack(&items, WINDOW, spacing), spacing);
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
        Placed::new(path, FillRule::NonZero, PlacedKind::Image)
    };
    // Two backgrounds larger than the window, a dot, and something far outside.
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
        crate::coverage::verdict::Verdict::forced(crate::coverage::verdict::Coverage::Msdf);
    let mut items = place(&drawing, &lattice, &vec![forced; drawing.items.len()]);
    items.retain(|item| item.kind != PlacedKind::Clip);
    let spacing = f64::from(config.distance_range_texels);
    check(&items, &pack(&items, everywhere, spacing), spacing);
}

/// Real drawings: members of a rank are disjoint, the order is kept, and ranks are as few as
/// possible.
#[test]
fn corpus_ranks_are_the_longest_chains() {
    let Some(corpus) = Corpus::find("layers of real drawings") else {
        return;
    };
    check_svg(&corpus.read("paper5/5_tiger__svgpan__tiger.svg"));
    // Brute force looks at every pair of lines, so only small files, some of every kind.
    let mut names = corpus.drawings();
    names.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
    names.retain(|path| path.metadata().is_ok_and(|file| file.len() <= 16 << 10));
    for path in names.iter().step_by(2) {
        check_svg(&std::fs::read(path).unwrap());
    }
}
