//! Each class of hard outline, as SVG path data, against exact windings of what was drawn.

use kurbo::{BezPath, Line, Point, Rect, Shape as _};

use vtex_format::{Preparation, WarningCode};
use vtex_shaders::{PackOptions, cpu, pack};

use super::{Method, Note, Prepared, by_overlay, by_sweep, clean, prepare, prepare_by};
use crate::{
    config::{BakeConfig, Mode},
    drawing::{Drawing, FillRule, Item, Shape},
    geometry::{Region, flatten_segment, line_box_distance},
    pipeline::assemble,
    testing::{Random, random_outline, shape},
};

/// Longer side of the canvas in these tests.
const CANVAS: f64 = 100.0;
/// Distance from an edge of the drawing within which the outlines may differ: a 50,000th of the
/// canvas.
const NEAR: f64 = 2e-3;

/// Name, outline, rule.
const CLASSES: [(&str, &str, FillRule); 15] = [
    (
        "near-zero handles",
        "M10 10C10.0001 10 40 9.9999 40 10C40 10.0001 39.9999 60 40 60L10 60Z",
        FillRule::NonZero,
    ),
    (
        "handles of no length",
        "M10 10C10 10 40 10 40 10C40 10 40 60 40 60Q40 60 10 60Z",
        FillRule::NonZero,
    ),
    ("sliver", "M10 10L90 10.01L90 10.02Z", FillRule::NonZero),
    (
        "curved sliver",
        "M10 50C40 20 60 20 90 50C60 20.05 40 20.05 10 50Z",
        FillRule::NonZero,
    ),
    ("cusp of lines", "M10 50L90 49L10 48Z", FillRule::NonZero),
    (
        "cusp of a cubic",
        "M10 80C90 10 10 10 90 80Z",
        FillRule::NonZero,
    ),
    (
        "loop of a cubic",
        "M10 80C130 -20 -30 -20 90 80Z",
        FillRule::NonZero,
    ),
    ("self-crossing", "M10 10L90 90V10L10 90Z", FillRule::NonZero),
    (
        "star by non-zero",
        "M50 5L79 95L2 39H98L21 95Z",
        FillRule::NonZero,
    ),
    (
        "star by even-odd",
        "M50 5L79 95L2 39H98L21 95Z",
        FillRule::EvenOdd,
    ),
    (
        "nested twice by even-odd",
        "M10 10H90V90H10ZM30 30H70V70H30ZM40 40V60H60V40Z",
        FillRule::EvenOdd,
    ),
    (
        "duplicate points",
        "M10 10L10 10L50 10L50 10L50 10L50 60L50 60L10 60L10 10L10 10Z",
        FillRule::NonZero,
    ),
    (
        "no area",
        "M10 10L90 90L10 10ZM20 20H80H20ZM50 50ZM5 5L5 5Z",
        FillRule::NonZero,
    ),
    (
        "no area beside a square",
        "M10 10L90 90L10 10ZM20 20H60V60H20ZM30 20H50",
        FillRule::EvenOdd,
    ),
    (
        "edges on edges",
        "M10 10H50V50H10ZM50 10H90V50H50ZM10 50H50V90H10ZM30 10H70V50H30Z",
        FillRule::EvenOdd,
    ),
];

fn shape_of(outline: BezPath, rule: FillRule) -> Shape {
    match shape(outline, rule, [0.0, 0.0, 0.0, 1.0]) {
        Item::Shape(shape) => shape,
        Item::Image(_) | Item::Clip(_) => unreachable!("made as a shape"),
    }
}

fn near_an_edge(outline: &BezPath, p: Point) -> bool {
    let near = Rect::from_center_size(p, (2.0 * NEAR, 2.0 * NEAR));
    outline.segments().any(|segment| {
        segment.bounding_box().inflate(NEAR, NEAR).contains(p) && {
            let mut points = vec![kurbo::ParamCurve::start(&segment)];
            flatten_segment(segment, 1e-5, &mut points);
            let mut lines = points.windows(2).map(|e| Line::new(e[0], e[1]));
            lines.any(|line| line_box_distance(line, near) <= 0.0)
        }
    })
}

/// Compares what was prepared with what was drawn, all over the canvas and close to the edges.
fn compare(name: &str, drawn: &Shape, prepared: &Prepared) {
    let truth = Region::new(&clean(&drawn.outline, CANVAS), drawn.fill_rule);
    let found = Region::new(&prepared.outline, prepared.rule);
    let mut random = Random(3);
    let mut points: Vec<Point> = (0..4000)
        .map(|_| Point::new(random.within(0.0, CANVAS), random.within(0.0, CANVAS)))
        .collect();
    for segment in drawn.outline.segments() {
        for _ in 0..20 {
            let p = kurbo::ParamCurve::eval(&segment, random.within(0.0, 1.0));
            let off = |random: &mut Random| random.within(-0.05, 0.05);
            points.push(p + kurbo::Vec2::new(off(&mut random), off(&mut random)));
        }
    }
    let mut compared = 0;
    for p in points {
        if p.is_finite() && !near_an_edge(&drawn.outline, p) {
            assert_eq!(found.contains(p), truth.contains(p), "{name}: {p}");
            compared += 1;
        }
    }
    assert!(compared > 3000, "{name}: {compared}");
}

#[test]
fn every_class_fills_what_was_drawn() {
    for (name, path, rule) in CLASSES {
        let drawn = shape_of(BezPath::from_svg(path).unwrap(), rule);
        let prepared = prepare(&drawn, CANVAS);
        assert!(prepared.outline.is_finite(), "{name}");
        assert_ne!(prepared.note, Note::Failed, "{name}");
        compare(name, &drawn, &prepared);
    }
}

#[test]
fn every_class_by_the_second_method() {
    for (name, path, rule) in CLASSES {
        let drawn = shape_of(BezPath::from_svg(path).unwrap(), rule);
        let prepared = prepare_by(&[|_, _| None, by_overlay], &drawn, CANVAS);
        let nothing = clean(&drawn.outline, CANVAS).elements().is_empty();
        assert!(
            nothing || prepared.note == Note::SecondMethod,
            "{name}: {:?}",
            prepared.note
        );
        compare(name, &drawn, &prepared);
    }
}

#[test]
fn random_outlines_by_both_methods() {
    let mut random = Random(12);
    for index in 0..120 {
        let outline = random_outline(&mut random, CANVAS);
        let rule = [FillRule::NonZero, FillRule::EvenOdd][index % 2];
        let drawn = shape_of(outline, rule);
        for (name, method) in [("sweep", by_sweep as Method), ("overlay", by_overlay)] {
            let prepared = prepare_by(&[method], &drawn, CANVAS);
            compare(
                &format!("{name} {index} {:?}", prepared.note),
                &drawn,
                &prepared,
            );
        }
    }
}

/// A method whose result differs from the drawing is not used.
#[test]
fn wrong_answers_are_found_out() {
    let nothing: Method = |_, _| None;
    let empty: Method = |_, _| Some(BezPath::new());
    let box_of: Method = |outline, _| Some(outline.bounding_box().to_path(0.1));
    let turned: Method = |outline, _| {
        let mirrored = kurbo::Affine::new([-1.0, 0.0, 0.0, 1.0, 1024.0, 0.0]);
        Some(mirrored * outline)
    };
    let not_a_number: Method = |_, _| {
        let mut outline = BezPath::new();
        outline.move_to((f64::NAN, 0.0));
        outline.line_to((1.0, 1.0));
        outline.close_path();
        Some(outline)
    };
    // All but a dent in one edge is right.
    let dented: Method = |outline, rule| {
        let mut dented = by_overlay(outline, rule)?;
        dented.extend(
            Rect::new(200.0, 100.0, 240.0, 110.0)
                .to_path(0.1)
                .reverse_subpaths(),
        );
        Some(dented)
    };
    let star = "M11 10C30 12 60 8 70 10L79 95L2 39H98L21 95Z";
    let drawn = shape_of(BezPath::from_svg(star).unwrap(), FillRule::EvenOdd);
    for wrong in [nothing, empty, box_of, turned, not_a_number, dented] {
        let prepared = prepare_by(&[wrong, by_overlay], &drawn, CANVAS);
        assert_eq!(prepared.note, Note::SecondMethod);
        compare("second", &drawn, &prepared);
        let prepared = prepare_by(&[by_sweep, wrong], &drawn, CANVAS);
        assert_eq!(prepared.note, Note::Simplified);
        compare("first", &drawn, &prepared);
        let prepared = prepare_by(&[wrong, wrong], &drawn, CANVAS);
        assert_eq!(
            (prepared.note, prepared.rule),
            (Note::Failed, FillRule::EvenOdd)
        );
        compare("as drawn", &drawn, &prepared);
    }
}

#[test]
fn notes_say_what_was_done() {
    let note = |path: &str, rule| {
        let drawn = shape_of(BezPath::from_svg(path).unwrap(), rule);
        prepare(&drawn, CANVAS).note
    };
    assert_eq!(note("M10 10H90V90H10Z", FillRule::EvenOdd), Note::AsDrawn);
    assert_eq!(
        note("M10 10L90 90V10L10 90Z", FillRule::NonZero),
        Note::Simplified
    );
    assert_eq!(note("", FillRule::NonZero), Note::AsDrawn);
}

/// An outline that reaches very far still has its edge at the same place of the canvas.
#[test]
fn huge_coordinates_keep_the_picture() {
    let huge = [
        ("rectangle", "M-1e30 -1e30H50V50H-1e30Z"),
        ("diagonal", "M0 0L1e12 1e12L-1e12 1e12Z"),
        ("diagonal that misses the corner", "M40 0L1e7 1e7L-2e7 1e7Z"),
        (
            "around the canvas",
            "M-1e20 -1e20H1e20V1e20H-1e20ZM20 20V80H80V20Z",
        ),
        ("curve", "M-1e7 0C-1e7 40 1e7 40 1e7 0V1e7H-1e7Z"),
        ("quadratic", "M-3e6 3e6Q50 -3e6 3e6 3e6Z"),
        ("beside", "M1e9 0L2e9 50L1e9 100Z"),
    ];
    for (name, path) in huge {
        let drawn = shape_of(BezPath::from_svg(path).unwrap(), FillRule::NonZero);
        let cleaned = clean(&drawn.outline, CANVAS);
        let farthest = 4096.0 * CANVAS;
        let area = cleaned.control_box();
        assert!(
            area.x0 >= -farthest && area.x1 <= farthest,
            "{name}: {area:?}"
        );
        assert!(
            area.y0 >= -farthest && area.y1 <= farthest,
            "{name}: {area:?}"
        );
        let [truth, found] = [&drawn.outline, &cleaned].map(|o| Region::new(o, FillRule::NonZero));
        let mut random = Random(5);
        for _ in 0..2000 {
            let p = Point::new(random.within(0.0, CANVAS), random.within(0.0, CANVAS));
            if !near_an_edge(&drawn.outline, p) {
                assert_eq!(found.winding(p), truth.winding(p), "{name}: {p}");
            }
        }
        let prepared = prepare(&drawn, CANVAS);
        let filled = Region::new(&prepared.outline, prepared.rule);
        let p = Point::new(50.0, 99.0);
        assert_eq!(filled.contains(p), truth.contains(p), "{name}");
    }
}

#[test]
fn what_is_near_stays_bit_identical() {
    let mut random = Random(6);
    for _ in 0..50 {
        let outline = clean(&random_outline(&mut random, CANVAS), 1e9);
        let mut both = outline.clone();
        both.extend(BezPath::from_svg("M0 -1e30L1e30 0L0 -1e25Z").unwrap());
        let clamped = clean(&both, CANVAS);
        let kept = outline.segments().count();
        assert!(clamped.segments().take(kept).eq(outline.segments()));
    }
}

#[test]
fn contours_without_numbers_vanish_alone() {
    let mut outline = BezPath::from_svg("M10 10H20V20H10Z").unwrap();
    outline.move_to((f64::NAN, 3.0));
    outline.line_to((f64::INFINITY, 0.0));
    outline.line_to((1.0, 1.0));
    outline.move_to((30.0, 30.0));
    outline.curve_to((f64::NEG_INFINITY, 0.0), (3.0, 4.0), (5.0, 6.0));
    let cleaned = clean(&outline, CANVAS);
    assert!(cleaned.is_finite());
    assert_eq!(cleaned.segments().count(), 4);
}

/// A closed contour may be followed by segments without a move: they start where it started.
#[test]
fn segments_after_a_closed_contour_start_at_its_start() {
    let mut outline = BezPath::new();
    outline.move_to((10.0, 10.0));
    outline.line_to((20.0, 10.0));
    outline.line_to((20.0, 20.0));
    outline.close_path();
    outline.line_to((0.0, 10.0));
    outline.line_to((0.0, 0.0));
    let cleaned = clean(&outline, CANVAS);
    let expected = "M10 10H20V20L10 10ZM10 10H0V0L10 10Z";
    let expected = clean(&BezPath::from_svg(expected).unwrap(), CANVAS);
    assert_eq!(cleaned, expected);
}

/// An outline too long for any method is baked as drawn, with a report and a warning, and looks
/// right.
#[test]
fn what_cannot_be_prepared_is_baked_as_drawn() {
    let mut outline = BezPath::new();
    for k in 0..20_100 {
        let turn = 2.0 * std::f64::consts::TAU * f64::from(k) / 20_100.0;
        let p = Point::new(50.0, 50.0) + 40.0 * kurbo::Vec2::from_angle(turn);
        if k == 0 {
            outline.move_to(p);
        } else {
            outline.line_to(p);
        }
    }
    outline.close_path();
    let drawing = Drawing::ungrouped(
        [CANVAS; 2],
        vec![shape(outline, FillRule::NonZero, [0.0, 0.0, 0.0, 1.0])],
    );
    let config = BakeConfig {
        mode: Mode::Msdf,
        msdf_size: 256,
        ..BakeConfig::default()
    };
    let file = assemble(drawing, None, &config, [0; 32], &|_| ()).unwrap();
    let provenance = file.provenance.as_ref().unwrap();
    assert_eq!(provenance.shapes[0].preparation, Preparation::Failed);
    assert_eq!(provenance.warnings[0].code, WarningCode::PathFallback);
    let packed = pack(&file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let mut random = Random(1);
    for _ in 0..2000 {
        let p = Point::new(random.within(0.0, CANVAS), random.within(0.0, CANVAS));
        let radius = (p - Point::new(50.0, 50.0)).hypot();
        if (radius - 40.0).abs() > 0.3 {
            let uv = [p.x / CANVAS, p.y / CANVAS].map(crate::number::to_f32);
            let filled = sampler.sample(uv, [0.0; 4])[3] > 0.5;
            assert_eq!(filled, radius < 40.0, "{p}");
        }
    }
}
