use kurbo::{BezPath, Line, ParamCurve, Point, Rect, Shape as _};

use super::{Region, clip_line, flatten, line_box_distance, line_line_distance};
use crate::{
    drawing::FillRule,
    testing::{Random, random_outline},
};

/// Winding by the angle that the outline turns around `p`, which shares nothing with the code
/// tested.
fn winding_by_angle(outline: &BezPath, p: Point) -> i32 {
    let mut turn = 0.0;
    for contour in flatten(outline, 1e-4) {
        for ends in contour.windows(2) {
            let (a, b) = (ends[0] - p, ends[1] - p);
            turn += a.cross(b).atan2(a.dot(b));
        }
    }
    #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
    let turns = (turn / std::f64::consts::TAU).round() as i32;
    turns
}

#[test]
fn winding_equals_the_turning_angle_away_from_edges() {
    let mut random = Random(7);
    let mut compared = 0;
    for _ in 0..60 {
        let outline = random_outline(&mut random, 100.0);
        let region = Region::new(&outline, FillRule::NonZero);
        for _ in 0..200 {
            let p = Point::new(random.within(-20.0, 120.0), random.within(-20.0, 120.0));
            let near = flatten(&outline, 1e-4).iter().any(|contour| {
                let mut lines = contour.windows(2).map(|ends| Line::new(ends[0], ends[1]));
                lines.any(|line| line_line_distance(line, Line::new(p, p)) < 1e-3)
            });
            if !near {
                assert_eq!(
                    region.winding(p),
                    winding_by_angle(&outline, p),
                    "{p} {outline:?}"
                );
                compared += 1;
            }
        }
    }
    assert!(
        compared > 10_000,
        "only {compared} points were away from edges"
    );
}

#[test]
fn rows_and_points_agree_everywhere() {
    let mut random = Random(8);
    for _ in 0..100 {
        let outline = random_outline(&mut random, 20.0);
        let region = Region::new(&outline, FillRule::EvenOdd);
        for row in -1..22 {
            let crossings = region.crossings(f64::from(row));
            for column in -1..22 {
                let p = Point::new(f64::from(column), f64::from(row));
                assert_eq!(region.fills_row(&crossings, p.x), region.contains(p));
            }
        }
    }
}

#[test]
fn winding_is_watertight_on_shared_vertices() {
    // Every vertex and every extremum of a ring of arcs: outside points at the same y stay outside.
    let circle = kurbo::Circle::new((10.0, 10.0), 5.0).to_path(1e-6);
    let region = Region::new(&circle, FillRule::NonZero);
    for segment in circle.segments() {
        for y in [segment.start().y, segment.eval(0.5).y] {
            assert!(!region.contains(Point::new(0.0, y)));
            assert!(!region.contains(Point::new(20.0, y)));
        }
    }
}

#[test]
fn an_empty_outline_contains_nothing() {
    let region = Region::new(&BezPath::new(), FillRule::NonZero);
    assert!(!region.contains(Point::ORIGIN));
    assert!(region.crossings(0.0).is_empty());
}

#[test]
fn flattening_stays_within_its_tolerance() {
    let mut random = Random(9);
    for _ in 0..50 {
        let outline = random_outline(&mut random, 100.0);
        let lines: Vec<Line> = flatten(&outline, 0.05)
            .iter()
            .flat_map(|contour| contour.windows(2).map(|ends| Line::new(ends[0], ends[1])))
            .collect();
        for segment in outline.segments() {
            for k in 0..16 {
                let p = segment.eval(f64::from(k) / 16.0);
                let distance = lines
                    .iter()
                    .map(|line| line_line_distance(*line, Line::new(p, p)))
                    .fold(f64::INFINITY, f64::min);
                assert!(distance <= 0.05, "{distance}");
            }
        }
    }
}

#[test]
fn distances_equal_dense_sampling() {
    let mut random = Random(10);
    let mut point =
        |low: f64, high: f64| Point::new(random.within(low, high), random.within(low, high));
    let along = |line: Line| (0..=200).map(move |k| line.eval(f64::from(k) / 200.0));
    for _ in 0..300 {
        let a = Line::new(point(0.0, 10.0), point(0.0, 10.0));
        let b = Line::new(point(0.0, 10.0), point(0.0, 10.0));
        let sampled = along(a)
            .flat_map(|p| along(b).map(move |q| (p - q).hypot()))
            .fold(f64::INFINITY, f64::min);
        let exact = line_line_distance(a, b);
        assert!(
            exact <= sampled + 1e-12 && sampled <= exact + 0.1,
            "{a:?} {b:?}"
        );

        let area = Rect::new(3.0, 4.0, 6.0, 5.0);
        let to_box = |p: Point| {
            let nearest = Point::new(p.x.clamp(3.0, 6.0), p.y.clamp(4.0, 5.0));
            (p - nearest).hypot()
        };
        let sampled = along(a).map(to_box).fold(f64::INFINITY, f64::min);
        let exact = line_box_distance(a, area);
        assert!(exact <= sampled + 1e-12 && sampled <= exact + 0.1, "{a:?}");
        if let Some(inside) = clip_line(a, area) {
            assert!(along(inside).all(|p| to_box(p) < 1e-9), "{a:?}");
        }
    }
}
