//! The judge against a denser check: MSDFs as baked, looked up by the evaluator's twin.

#![expect(clippy::print_stdout, reason = "the figures are wanted")]

use kurbo::{BezPath, Circle, ParamCurve, ParamCurveArclen, Point, Rect, Shape as _, Vec2};
use vtex_format::{Finding, VtexFile};
use vtex_shaders::{PackOptions, cpu, pack};
use vtex_testing::Corpus;

use super::{
    candidate::{Candidate, QUANTA, ROUNDING_QUANTA},
    judge,
    measure::{WRONG_SHARE_BOUND, measure},
    sizes,
};
use crate::{
    config::{BakeConfig, Mode},
    coverage::{placed::place_prepared, verdict::Coverage},
    drawing::{Drawing, FillRule, Item, Paint, Shape},
    geometry::{
        Region,
        prepare::{clean, prepare},
    },
    pipeline::assemble,
    testing::{Random, drawing_of, shape},
};

const BLACK: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
/// Percentiles of two sets of probes along one edge differ a little.
const SAMPLING: f64 = 1.1;

fn config(max_zoom: f32, error_px: f64) -> BakeConfig {
    BakeConfig {
        max_zoom,
        error_px,
        mip0_size: 512,
        ..BakeConfig::default()
    }
}

fn bake(drawing: Drawing, config: &BakeConfig) -> VtexFile {
    let file = assemble(drawing, None, config, [0; 32], &|_| ()).unwrap();
    assert_eq!(file.check(), []);
    file
}

fn drawing(canvas: f64, items: Vec<Item>) -> Drawing {
    Drawing::ungrouped([canvas; 2], items)
}

fn alone(canvas_size: [f64; 2], shape: &Shape) -> Drawing {
    let shape = Item::Shape(Shape {
        outline: shape.outline.clone(),
        element: shape.element.clone(),
        paint: Paint::BLACK,
        fill_rule: shape.fill_rule,
        source: shape.source,
    });
    Drawing::ungrouped(canvas_size, vec![shape])
}

/// What a dense check finds in the MSDF of one shape that is baked alone.
#[derive(Debug)]
struct Dense {
    p99_px: f64,
    wrong: f64,
    probes: u32,
}

/// Walks from points of the outline as drawn along their normals to where the picture changes.
fn dense_check(canvas_size: [f64; 2], shape: &Shape, config: &BakeConfig) -> Dense {
    let file = bake(
        alone(canvas_size, shape),
        &BakeConfig {
            mode: Mode::Msdf,
            ..config.clone()
        },
    );
    let packed = pack(&file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let longer = canvas_size[0].max(canvas_size[1]);
    let outline = clean(&shape.outline, longer);
    let truth = Region::new(&outline, shape.fill_rule);
    let filled = |p: Point| {
        let uv = [p.x / canvas_size[0], p.y / canvas_size[1]].map(crate::number::to_f32);
        sampler.sample(uv, [0.0; 4])[3] > 0.5
    };
    let units_per_px = longer / (config.longer_side_px());
    let step = longer / f64::from(config.msdf_size);
    let near = 1e-3 * units_per_px;
    // Walks must not leave the canvas.
    let [width, height] = canvas_size;
    let inner = Rect::new(0.0, 0.0, width, height).inset(-3.0 * step);
    let on_canvas = |p: Point| inner.contains(p);
    let mut random = Random(17);
    let mut found = Vec::new();
    let (mut wrong, mut compared) = (0, 0);
    let mut left_over = 0.0;
    for segment in outline.segments() {
        // Eight probes a texel, as many for each length of the edge.
        let length = segment.arclen(1e-6 * longer);
        left_over += 8.0 * length / step;
        while left_over >= 1.0 {
            left_over -= 1.0;
            let t = segment.inv_arclen(random.within(0.0, length), 1e-6 * longer);
            let p = segment.eval(t);
            let along = segment.eval((t + 1e-4).min(1.0)) - segment.eval((t - 1e-4).max(0.0));
            let normal = Vec2::new(-along.y, along.x).normalize();
            // Where contours overlap, an edge inside the shape does not count.
            let sides = [p + near * normal, p - near * normal].map(|p| truth.contains(p));
            if !normal.is_finite() || !on_canvas(p) || sides[0] == sides[1] {
                continue;
            }
            let inwards = if sides[0] { normal } else { -normal };
            let off = displacement(&filled, &truth, p, inwards, 2.0 * step);
            found.push(off / units_per_px);
            let q = p + random.within(-1.5, 1.5) * step * normal;
            let radius = config.error_px * units_per_px;
            compared += 1;
            wrong += u32::from(filled(q) != truth.contains(q) && is_clear(&truth, q, radius));
        }
    }
    found.sort_by(f64::total_cmp);
    Dense {
        p99_px: found.get(found.len() * 99 / 100).copied().unwrap_or(0.0),
        wrong: f64::from(wrong) / f64::from(compared.max(1)),
        probes: u32::try_from(found.len()).unwrap(),
    }
}

/// Whether everything within `radius` of `p` is on the same side as `p`.
fn is_clear(truth: &Region, p: Point, radius: f64) -> bool {
    let here = truth.contains(p);
    (0..16).all(|k| {
        let around = Vec2::from_angle(f64::from(k) * std::f64::consts::TAU / 16.0);
        truth.contains(p + radius * around) == here
    })
}

/// How far from the edge at `p` the picture changes: inwards where `p` is not filled, else
/// outwards. An edge that has vanished has met the next one, of the shape or of a gap in it,
/// halfway.
fn displacement(
    filled: &impl Fn(Point) -> bool,
    truth: &Region,
    p: Point,
    inwards: Vec2,
    most: f64,
) -> f64 {
    let grown = filled(p);
    let along = if grown { -inwards } else { inwards };
    let walk = || (1..=100).map(|k| most * (f64::from(k) / 100.0).powi(2));
    let next = walk().find(|&s| truth.contains(p + s * along) == grown);
    let end = next.map_or(most, |s| 0.5 * s);
    let change = walk().find(|&s| filled(p + s * along) != grown);
    change.map_or(end, |s| s.min(end))
}

fn samples() -> Vec<(&'static str, Drawing)> {
    let names = [
        "paper5/5_tiger__svgpan__tiger.svg",
        "paper5/4_coat_of_arms__openclipart-svg__saxony_coat_of_arms_me_01.svg",
        "paper5/3_text__matplotlib__mathtext_cm_54.svg",
    ];
    let Some(corpus) = Corpus::find("the judge on real drawings") else {
        return Vec::new();
    };
    let drawing = |name: &str| drawing_of(&corpus.read(name), &config(4.0, 0.1));
    names.map(|name| (name, drawing(name))).into()
}

/// Shapes of real drawings on lattices and with bounds near the limit: the judge accepts what is
/// good and rejects what is not.
#[test]
fn the_judge_is_right_about_real_shapes() {
    let (mut good, mut bad, mut in_vain) = (0, 0, 0);
    let samples = samples();
    for (name, drawing) in &samples {
        for (size, zoom, error) in [(384, 1.0, 0.1), (256, 2.0, 0.25), (768, 4.0, 0.3)] {
            let config = BakeConfig {
                msdf_size: size,
                ..config(zoom, error)
            };
            let candidate = Candidate::new(drawing, &config, size);
            for item in drawing.items.iter().step_by(5) {
                let Item::Shape(shape) = item else { continue };
                let dense = dense_check(drawing.canvas_size, shape, &config);
                // So that a p99 rests on five probes and more.
                if dense.probes < 500 {
                    continue;
                }
                let longer = drawing.canvas_size[0].max(drawing.canvas_size[1]);
                let placed = place_prepared(&prepare(shape, longer), &candidate.lattice);
                let measured = measure(&placed, &candidate);
                let text = format!("{name} {} {size} {measured:?} {dense:?}", shape.element);
                // Percentiles of two sets of probes differ, most where there are few.
                let slack = SAMPLING + 4.0 / f64::from(dense.probes).sqrt();
                if measured.within(error) {
                    good += 1;
                    let sound = dense.p99_px <= slack * error;
                    assert!(sound && dense.wrong <= 2.0 * WRONG_SHARE_BOUND, "{text}");
                } else {
                    bad += 1;
                    let off = dense.p99_px * slack >= error;
                    let exceeds = off || dense.wrong > 0.5 * WRONG_SHARE_BOUND;
                    in_vain += u32::from(!exceeds);
                    assert_ne!(measured.cause, Finding::None, "{text}");
                }
            }
        }
    }
    println!("{good} good, {bad} rejected, {in_vain} of them in vain");
    // A field that is rejected without need costs bytes but no quality. It happens with needles,
    // whose tips evenly spread probes meet and random ones miss.
    assert!(in_vain * 10 <= bad, "{in_vain} of {bad}");
    let enough = good > 20 && bad > 40;
    assert!(samples.is_empty() || enough, "{good} good, {bad} bad");
}

/// A rounded blob, a ring, a hairline and a comb on a canvas of 100.
fn mixed() -> Drawing {
    let path = |text: &str| BezPath::from_svg(text).unwrap();
    let mut ring = Circle::new((25.0, 70.0), 20.0).to_path(1e-4);
    ring.extend(
        Circle::new((25.0, 70.0), 8.0)
            .to_path(1e-4)
            .reverse_subpaths(),
    );
    let mut comb = String::from("M60 60");
    for k in 0..40 {
        let x = 60.0 + f64::from(k);
        comb += &format!("L{x} 64L{} 90L{} 90L{} 64", x + 0.1, x + 0.2, x + 0.3);
    }
    comb += "L100 60Z";
    let outlines = [
        Circle::new((30.0, 25.0), 20.0).to_path(1e-4),
        ring,
        path("M5 48H95V48.2H5Z"),
        path(&comb),
    ];
    let items = outlines.map(|outline| shape(outline, FillRule::NonZero, BLACK));
    drawing(100.0, items.into())
}

/// Smooth fields with so many segments that tiles pay.
fn gears() -> Drawing {
    let gear = |x: f64, y: f64| {
        let mut outline = BezPath::new();
        for k in 0..160 {
            let angle = f64::from(k) * std::f64::consts::TAU / 160.0;
            let radius = 11.0 + 0.02 * f64::from(k % 2);
            let p = Point::new(x, y) + radius * Vec2::from_angle(angle);
            if k == 0 {
                outline.move_to(p);
            } else {
                outline.line_to(p);
            }
        }
        outline.close_path();
        shape(outline, FillRule::NonZero, BLACK)
    };
    let places = [20.0, 50.0, 80.0];
    let items = places.iter().flat_map(|&x| places.map(|y| gear(x, y)));
    drawing(100.0, items.collect())
}

#[test]
fn hairlines_are_curves_unmeasured() {
    let config = config(1.0, 0.1);
    let verdicts = judge(&mixed(), &config).verdicts;
    for verdict in &verdicts[2..] {
        let found = (verdict.coverage, verdict.finding, verdict.error);
        assert_eq!(found, (Coverage::Curves, Finding::Hairline, None));
    }
    for verdict in &verdicts[..2] {
        assert_ne!(verdict.finding, Finding::Hairline);
        assert!(verdict.error.is_some());
    }
}

/// The cause of errors is named.
#[test]
fn causes_are_named() {
    let path = |text: &str| BezPath::from_svg(text).unwrap();
    let needle = path("M40.3 50.2L43.3 50.8V49.6Z");
    // Two wide bars that leave a gap of half a texel.
    let gap = path("M20 20H80V40H20ZM20 40.4H80V60H20Z");
    let round = Circle::new((50.0, 50.0), 3.0).to_path(1e-4);
    let cases = [
        (needle, 4.0, Finding::Cusp),
        (gap, 2.0, Finding::ThinFeature),
        (round, 32.0, Finding::Displaced),
    ];
    for (outline, zoom, cause) in cases {
        let item = shape(outline, FillRule::NonZero, BLACK);
        let drawing = drawing(100.0, vec![item]);
        let Item::Shape(shape) = &drawing.items[0] else {
            unreachable!("a shape")
        };
        let config = config(zoom, 0.2);
        let candidate = Candidate::new(&drawing, &config, 96);
        let placed = place_prepared(&prepare(shape, 100.0), &candidate.lattice);
        let measured = measure(&placed, &candidate);
        assert!(!measured.within(0.2), "{measured:?}");
        assert_eq!(measured.cause, cause, "{measured:?}");
    }
}

#[test]
fn auto_takes_fields_where_they_pay_and_they_keep_the_bound() {
    for (zoom, error) in [(1.0, 0.1), (2.0, 0.25), (4.0, 0.5)] {
        let config = config(zoom, error);
        let judgement = judge(&gears(), &config);
        let fields = judgement
            .verdicts
            .iter()
            .filter(|v| v.coverage == Coverage::Msdf);
        assert_eq!(fields.count(), 9, "{zoom}: {judgement:?}");
        assert!(judgement.msdf_size < 1024, "the error drives the size");
        let baked = BakeConfig {
            msdf_size: judgement.msdf_size,
            ..config.clone()
        };
        for item in gears().items.iter().step_by(4) {
            let Item::Shape(shape) = item else { continue };
            let dense = dense_check([100.0; 2], shape, &baked);
            assert!(dense.p99_px <= SAMPLING * error, "{zoom}: {dense:?}");
        }
        let file = bake(gears(), &config);
        let reports = file.provenance.unwrap().shapes;
        for report in &reports {
            let measured = report.msdf_error.unwrap();
            assert!(f64::from(measured.p99_px) <= error && measured.wrong_share <= 1e-3);
            assert_eq!(report.finding, Finding::None);
            assert_eq!(
                report.size_texels,
                reports[0].size_texels.max(report.size_texels)
            );
        }
    }
    // Wide zoom and few segments: curves, and nothing is measured.
    let default = BakeConfig::default();
    let judgement = judge(&gears(), &default);
    for verdict in judgement.verdicts {
        assert_eq!(verdict.coverage, Coverage::Curves);
        assert_eq!(
            (verdict.finding, verdict.error),
            (Finding::Quantisation, None)
        );
    }
}

/// A smaller bound never leads to a coarser lattice, as long as the shapes stay MSDFs.
#[test]
fn the_size_follows_the_error() {
    let mut before = 0;
    for error in [1.0, 0.5, 0.25] {
        let config = config(2.0, error);
        let judgement = judge(&gears(), &config);
        assert!(
            judgement
                .verdicts
                .iter()
                .all(|v| v.coverage == Coverage::Msdf),
            "{error}"
        );
        assert!(
            judgement.msdf_size >= before,
            "{error}: {}",
            judgement.msdf_size
        );
        before = judgement.msdf_size;
    }
    assert!(before >= 96);
}

#[test]
fn modes_force_one_kind() {
    for (mode, coverage) in [
        (Mode::Msdf, Coverage::Msdf),
        (Mode::Curves, Coverage::Curves),
    ] {
        let config = BakeConfig {
            mode,
            ..config(1.0, 0.1)
        };
        for verdict in judge(&mixed(), &config).verdicts {
            assert_eq!(
                (verdict.coverage, verdict.finding),
                (coverage, Finding::None)
            );
        }
    }
}

#[test]
fn verdicts_are_the_same_at_any_thread_count() {
    let config = config(2.0, 0.1);
    let judged = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| [mixed(), gears()].map(|drawing| judge(&drawing, &config)))
    });
    assert_eq!(judged[0], judged[1]);
    assert_eq!(judged[0], judged[2]);
}

#[test]
fn sizes_double_and_add_half() {
    assert_eq!(sizes(200), [32, 48, 64, 96, 128, 192, 200]);
    assert_eq!(sizes(192), [32, 48, 64, 96, 128, 192]);
    assert_eq!(sizes(16), [16]);
}

/// Sizes are skipped if rounding alone exceeds the bound. The error that the rule assumes is never
/// more than rounding really does to straight edges, at any angle.
#[test]
fn rounding_alone_costs_what_the_rule_says() {
    let mut least = f64::INFINITY;
    let mut random = Random(2);
    for k in 0..60 {
        let turn = kurbo::Affine::rotate_about(0.013 + 0.026 * f64::from(k), (50.0, 50.0));
        let corner = (random.within(20.0, 30.0), random.within(20.0, 30.0));
        let square = turn * Rect::from_origin_size(corner, (45.0, 45.0)).to_path(0.1);
        let drawing = drawing(100.0, vec![shape(square, FillRule::NonZero, BLACK)]);
        let Item::Shape(shape) = &drawing.items[0] else {
            unreachable!("a shape")
        };
        let config = config(64.0, 0.01);
        let candidate = Candidate::new(&drawing, &config, 256);
        let placed = place_prepared(&prepare(shape, 100.0), &candidate.lattice);
        let quantum_px = candidate.scales.range / QUANTA * candidate.px_per_step;
        least = least.min(measure(&placed, &candidate).p99_px / quantum_px);
    }
    println!("{least:.3} quanta");
    assert!(least >= ROUNDING_QUANTA, "{least}");
}
