//! Curves against exact windings, looked up by the evaluator's twin.

use kurbo::{Line, Point, Rect, Shape as _};
use vtex_format::VtexFile;
use vtex_shaders::{PackOptions, cpu, pack};
use vtex_testing::{Corpus, slow};

use crate::{
    config::{BakeConfig, Mode},
    coverage::{
        grid::Lattice,
        placed::{Placed, PlacedKind, place},
        verdict::{Coverage, Verdict},
    },
    drawing::Drawing,
    geometry::{flatten_segment, line_box_distance},
    pipeline::assemble,
    testing::{Random, drawing_of, solid},
};

/// A lookup this near to an edge, in steps, may fall on either side: a tenth of a pixel at zoom 64.
const NEAR_STEPS: f64 = 0.1 / 32.0;

fn config() -> BakeConfig {
    BakeConfig {
        mode: Mode::Curves,
        mip0_size: 64,
        ..BakeConfig::default()
    }
}

fn bake(drawing: Drawing, config: &BakeConfig) -> VtexFile {
    let file = assemble(drawing, None, config, [0; 32], &|_| ()).unwrap();
    assert_eq!(file.check(), []);
    assert_eq!(file.outlines.is_some(), !file.curves.is_empty());
    file
}

fn near_an_edge(item: &Placed, p: Point) -> bool {
    let side = 2.0 * NEAR_STEPS;
    let near = Rect::from_center_size(p, (side, side));
    item.outline.segments().any(|segment| {
        segment.bounding_box().overlaps(near) && {
            let mut points = vec![kurbo::ParamCurve::start(&segment)];
            flatten_segment(segment, 1e-5, &mut points);
            let mut lines = points.windows(2).map(|e| Line::new(e[0], e[1]));
            lines.any(|line| line_box_distance(line, near) <= 0.0)
        }
    })
}

/// Compares which opaque shape is in front at random points: `(compared, wrong)`.
fn compare(drawing: &Drawing, file: &VtexFile, config: &BakeConfig, points: u32) -> (u32, u32) {
    let lattice = Lattice::for_curves(drawing.canvas_size, config.msdf_size);
    assert_eq!(lattice.grid, file.meta.grid);
    let verdicts = vec![Verdict::forced(Coverage::Curves); drawing.items.len()];
    let placed = place(drawing, &lattice, &verdicts);
    let packed = pack(file, &PackOptions::default());
    let sampler = cpu::Sampler::new(&packed);
    let mut random = Random(9);
    let (mut compared, mut wrong) = (0, 0);
    for _ in 0..points {
        let uv = [random.within(0.0, 1.0), random.within(0.0, 1.0)].map(crate::number::to_f32);
        let canvas = lattice.canvas;
        let p = Point::new(
            canvas.x0 + f64::from(uv[0]) * canvas.width(),
            canvas.y0 + f64::from(uv[1]) * canvas.height(),
        );
        if placed.iter().any(|item| near_an_edge(item, p)) {
            continue;
        }
        let frontmost = placed.iter().rev().find_map(|item| match &item.kind {
            PlacedKind::Shape { paint, .. } if item.region.contains(p) => Some(solid(paint)),
            _ => None,
        });
        let seen = sampler.sample(uv, [0.0; 4]);
        let expected = match frontmost {
            Some([r, g, b, 1.0]) => {
                let [r, g, b] = cpu::color::decode([r, g, b]);
                [r, g, b, 1.0]
            }
            Some(_) => continue,
            None => [0.0; 4],
        };
        compared += 1;
        wrong += u32::from(seen.iter().zip(expected).any(|(a, b)| (a - b).abs() > 1e-4));
    }
    (compared, wrong)
}

#[test]
fn curve_cells_show_the_front_shape() {
    let names = [
        "paper5/5_tiger__svgpan__tiger.svg",
        "paper5/1_figures_text__openclipart-svg__facilement_inflammable_y_01.svg",
        "paper5/4_coat_of_arms__iso-flags-svg__gu.svg",
    ];
    let Some(corpus) = Corpus::find("curve cells of three drawings") else {
        return;
    };
    let points = if slow() { 300_000 } else { 30_000 };
    for name in names {
        let svg = corpus.read(name);
        let config = config();
        let mut drawing = drawing_of(&svg, &config);
        let mut again = drawing_of(&svg, &config);
        for drawing in [&mut drawing, &mut again] {
            let shapes = |item: &crate::drawing::Item| matches!(item, crate::drawing::Item::Shape(shape) if shape.paint.is_opaque());
            drawing.items.retain(shapes);
        }
        let file = bake(drawing, &config);
        let (compared, wrong) = compare(&again, &file, &config, points);
        assert_eq!(wrong, 0, "{name}: of {compared}");
        assert!(compared > points / 2, "{name}: {compared}");
    }
}
