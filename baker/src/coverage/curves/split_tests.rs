//! Cells with more of an outline than a record holds, in whole bakes, against exact windings.

use kurbo::{BezPath, Point, Rect, Shape as _};
use vtex_format::{COVERAGE_CURVES, COVERAGE_IMAGE, Entry, Finding, VtexFile, WarningCode};
use vtex_shaders::{PackOptions, cpu, pack};

use crate::{
    config::{BakeConfig, Mode},
    drawing::{Drawing, FillRule, Item},
    error::BakeError,
    geometry::{Region, clip_line, flatten, line_box_distance, prepare::clean},
    pipeline::assemble,
    testing::{Random, shape},
};

const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
/// A cell of the usual grid is 100 / 64 units wide; this lies inside one.
const CELL: Rect = Rect::new(50.2, 50.4, 51.0, 51.2);

fn config() -> BakeConfig {
    BakeConfig {
        mode: Mode::Curves,
        max_zoom: 256.0,
        ..BakeConfig::default()
    }
}

fn drawing(items: Vec<Item>) -> Drawing {
    Drawing::ungrouped([100.0; 2], items)
}

fn bake(outline: &BezPath, rule: FillRule) -> VtexFile {
    let items = vec![shape(outline.clone(), rule, BLACK)];
    let file = assemble(drawing(items), None, &config(), [0; 32], &|_| ()).unwrap();
    assert_eq!(file.check(), []);
    file
}

/// `(compared, wrong)` among random points of `area` that keep clear of edges by `clear` units.
fn compare(file: &VtexFile, outline: &BezPath, rule: FillRule, area: Rect, clear: f64) -> [u32; 2] {
    let truth = Region::new(&clean(outline, 100.0), rule);
    let near = area.inflate(0.01, 0.01);
    let lines: Vec<_> = flatten(&clean(outline, 100.0), 1e-6)
        .iter()
        .flat_map(|c| {
            c.windows(2)
                .map(|e| kurbo::Line::new(e[0], e[1]))
                .collect::<Vec<_>>()
        })
        .filter(|line| clip_line(*line, near).is_some())
        .collect();
    let packed = pack(file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let mut random = Random(4);
    let (mut compared, mut wrong) = (0, 0);
    for _ in 0..500 {
        let p = Point::new(
            random.within(area.x0, area.x1),
            random.within(area.y0, area.y1),
        );
        let near = Rect::from_center_size(p, (2.0 * clear, 2.0 * clear));
        if lines
            .iter()
            .any(|&line| line_box_distance(line, near) <= 0.0)
        {
            continue;
        }
        let uv = [p.x / 100.0, p.y / 100.0].map(crate::number::to_f32);
        let filled = sampler.sample(uv, [0.0; 4])[3] > 0.5;
        compared += 1;
        wrong += u32::from(filled != truth.contains(p));
    }
    [compared, wrong]
}

fn assert_split_and_exact(name: &str, outline: &BezPath, rule: FillRule) {
    let file = bake(outline, rule);
    assert_eq!(file.shapes[0].coverage, COVERAGE_CURVES, "{name}");
    // One shape: a list is longer than one entry only where the shape takes several.
    let (pairs, _) = file.entries.as_chunks();
    let mut entries = pairs.iter().filter_map(|&words| Entry::decode(words));
    let split = entries.any(|entry| !entry.last);
    assert!(split, "{name}: nothing had to be split");
    assert_exact(name, &file, outline, rule);
}

fn assert_exact(name: &str, file: &VtexFile, outline: &BezPath, rule: FillRule) {
    for area in [CELL, CELL.inset(2.0)] {
        let [compared, wrong] = compare(file, outline, rule, area, 1e-4);
        assert_eq!(wrong, 0, "{name}: of {compared}");
        assert!(compared > 100, "{name}: {compared}");
    }
}

fn triangles(count: u32, size: f64) -> BezPath {
    let mut random = Random(8);
    let mut outline = BezPath::new();
    for _ in 0..count {
        let p = Point::new(
            random.within(CELL.x0, CELL.x1),
            random.within(CELL.y0, CELL.y1),
        );
        let mut near = || (random.within(-size, size), random.within(-size, size));
        outline.move_to(p);
        outline.line_to(p + near());
        outline.line_to(p + near());
        outline.close_path();
    }
    outline
}

#[test]
fn twenty_thousand_triangles_in_a_cell() {
    let outline = triangles(20_000, 0.004);
    assert_split_and_exact("triangles", &outline, FillRule::NonZero);
    assert_split_and_exact("triangles", &outline, FillRule::EvenOdd);
}

#[test]
fn many_curves_in_a_cell() {
    let mut outline = BezPath::new();
    let mut random = Random(9);
    for _ in 0..2500 {
        let center = (
            random.within(CELL.x0, CELL.x1),
            random.within(CELL.y0, CELL.y1),
        );
        let circle = kurbo::Circle::new(center, random.within(0.002, 0.01));
        outline.extend(circle.to_path(1e-4));
    }
    assert_split_and_exact("circles", &outline, FillRule::EvenOdd);
}

/// A long comb ends to the left of the cell, in more steps than a record holds.
#[test]
fn more_steps_than_a_record_holds() {
    let mut outline = BezPath::new();
    for k in 0..700 {
        let y = 50.4 + 0.001 * f64::from(k);
        outline.extend(Rect::new(20.0, y, 50.7, y + 0.0005).to_path(0.1));
    }
    assert_split_and_exact("comb", &outline, FillRule::NonZero);
}

/// Squares on top of each other: the winding falls from 1200 to zero inside the cell.
#[test]
fn more_winding_than_a_record_holds() {
    let mut outline = BezPath::new();
    for k in 0..1200 {
        let end = 50.5 + 0.0004 * f64::from(k);
        outline.extend(Rect::new(10.0, 10.0, end, end).to_path(0.1));
    }
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        let file = bake(&outline, rule);
        assert_eq!(file.shapes[0].coverage, COVERAGE_CURVES);
        assert_exact("squares", &file, &outline, rule);
    }
}

/// Strips cannot help if everything runs from top to bottom: the shape becomes an image.
#[test]
fn a_scribble_of_fifty_thousand_segments_is_painted() {
    let mut random = Random(10);
    let mut outline = BezPath::new();
    outline.move_to((CELL.x0, CELL.y0));
    for k in 0..50_000 {
        let y = if k % 2 == 0 { CELL.y1 } else { CELL.y0 };
        outline.line_to((random.within(CELL.x0, CELL.x1), y));
    }
    outline.close_path();
    let file = bake(&outline, FillRule::NonZero);
    assert_eq!(file.shapes[0].coverage, COVERAGE_IMAGE);
    let provenance = file.provenance.as_ref().unwrap();
    assert_eq!(provenance.shapes[0].finding, Finding::TooManySegments);
    assert_eq!(provenance.warnings.len(), 1);
    assert_eq!(provenance.warnings[0].code, WarningCode::PathFallback);
    // It is nearly solid; a texel is a 4096th of the canvas.
    let packed = pack(&file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let at = |p: Point| {
        let uv = [p.x / 100.0, p.y / 100.0].map(crate::number::to_f32);
        sampler.sample(uv, [1e-3, 0.0, 0.0, 1e-3])[3]
    };
    assert!(at(CELL.center()) > 0.9, "{}", at(CELL.center()));
    for outside in [(49.9, 50.8), (51.3, 50.8), (50.6, 50.1), (50.6, 51.5)] {
        assert!(at(outside.into()) < 0.02, "{outside:?}");
    }
}

/// Too many translucent squares for one cell's list are refused with a clear error.
#[test]
fn too_many_entries_are_refused() {
    let square = |k: u32| {
        let side = 0.3 + 1e-3 * f64::from(k % 7);
        let color = [
            0.0,
            0.0,
            crate::number::to_f32(f64::from(k % 250) / 250.0),
            0.5,
        ];
        let outline = Rect::from_center_size(CELL.center(), (side, side)).to_path(0.1);
        shape(outline, FillRule::NonZero, color)
    };
    let result = assemble(
        drawing((0..4100).map(square).collect()),
        None,
        &config(),
        [0; 32],
        &|_| (),
    );
    match result {
        Err(BakeError::Limit(text)) => assert!(text.contains("4096"), "{text}"),
        other => panic!("{:?}", other.map(|file| file.entries.len())),
    }
}
