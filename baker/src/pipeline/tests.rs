//! Measurements, run by hand: `cargo test --release -p vtex-baker -- --ignored --nocapture`.

#![expect(
    clippy::print_stdout,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "measurements are for people"
)]

use std::time::Instant;

use vtex_testing::Corpus;

use crate::{
    config::{BakeConfig, Mode, Stage},
    coverage::grid::Lattice,
    pipeline::assemble,
    testing::{Evaluator, Random, drawing_of, paint_exactly, psnr, render, write_png},
};

#[test]
#[ignore = "prints measurements"]
fn measure_tiger() {
    let Some(corpus) = Corpus::find("measurements of the tiger") else {
        return;
    };
    let svg = corpus.read("paper5/5_tiger__svgpan__tiger.svg");
    let config = BakeConfig {
        mode: Mode::Msdf,
        ..BakeConfig::default()
    };
    let drawing = drawing_of(&svg, &config);
    let size = [512, 512];
    let exact = paint_exactly(&drawing.items, drawing.canvas_size);
    let full = [0.0, 0.0, 1.0, 1.0];
    let truth = render(&exact, size, full, 8);
    write_png("tiger_exact.png", size, &truth);
    let sampled = render(&exact, size, full, 4);
    println!("exact 16 spp: {:.2} dB", psnr(&truth, &sampled));
    for msdf_size in [512, 1024] {
        let config = BakeConfig {
            mode: Mode::Msdf,
            msdf_size,
            ..BakeConfig::default()
        };
        let last = std::sync::Mutex::new((Stage::Parse, Instant::now()));
        let observer = |stage: Stage| {
            let mut last = last.lock().unwrap();
            let elapsed_ms = last.1.elapsed().as_secs_f64() * 1e3;
            println!("  {:?} {elapsed_ms:.1} ms", last.0);
            *last = (stage, Instant::now());
        };
        let file = assemble(drawing_of(&svg, &config), None, &config, [0; 32], &observer).unwrap();
        observer(Stage::Encode);
        let evaluator = Evaluator { file: &file };
        let [entries, single] = listed(&evaluator);
        let picture = render(|uv| evaluator.point(uv), size, full, 4);
        write_png(&format!("tiger_{msdf_size}.png"), size, &picture);
        let zoom = [0.4, 0.3, 0.525, 0.425];
        let zoomed = render(|uv| evaluator.point(uv), size, zoom, 4);
        write_png(&format!("tiger_{msdf_size}_zoom8.png"), size, &zoomed);
        let zoomed_truth = render(&exact, size, zoom, 4);
        write_png("truth_zoom8.png", size, &zoomed_truth);
        let bytes = file.to_bytes().unwrap();
        let mut random = Random(3);
        let mut wrong = 0;
        for _ in 0..200_000 {
            let uv = [random.within(0.0, 1.0), random.within(0.0, 1.0)];
            let (a, b) = (exact(uv), evaluator.point(uv));
            wrong += u32::from(a.iter().zip(&b).any(|(a, b)| (a - b).abs() > 1e-4));
        }
        println!(
            "stored {} KiB, entries {} KiB, cells {} KiB, wrong points {:.3}%",
            bytes.len() / 1024,
            file.entries.len() / 256,
            file.cells.len() / 256,
            f64::from(wrong) / 2000.0
        );
        println!(
            "{msdf_size}: {:.2} dB, zoom8 {:.2} dB, {} shapes {} layers {} tiles {} KiB, cells {:?} n {}, entries/sample {:.3}, single {:.1}%, entries {} paints {}",
            psnr(&truth, &picture),
            psnr(&zoomed_truth, &zoomed),
            file.shapes.len(),
            file.layers.len(),
            file.layers.iter().map(|l| l.tile_count).sum::<u32>(),
            file.tiles.len() / 1024,
            file.meta.grid.size_cells,
            file.meta.grid.texels_per_cell,
            entries as f64 / 1e5,
            single as f64 / 1e3,
            file.entries.len() / 2,
            file.paints.len(),
        );
    }
}

/// Entries that 100,000 lookups meet, and how many lookups meet no list.
fn listed(evaluator: &Evaluator<'_>) -> [usize; 2] {
    let (mut entries, mut single) = (0, 0);
    for i in 0..100_000 {
        let uv = [f64::from(i % 317) / 317.0, f64::from(i / 317) / 317.0];
        let (word, list, _) = evaluator.entries(uv);
        entries += list.len();
        single += usize::from(!matches!(word, vtex_format::CellWord::List { .. }));
    }
    [entries, single]
}

/// One shape, tile by tile and by fdsm alone over the box of its tiles.
#[test]
#[ignore = "prints measurements"]
fn measure_against_fdsm() {
    let config = BakeConfig {
        mode: Mode::Msdf,
        msdf_size: 1024,
        ..BakeConfig::default()
    };
    let Some(corpus) = Corpus::find("measurements of the tiger") else {
        return;
    };
    let svg = corpus.read("paper5/5_tiger__svgpan__tiger.svg");
    let lattice = Lattice::new(drawing_of(&svg, &config).canvas_size, config.msdf_size);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let mut total = [0.0; 2];
    let mut texels = [0; 2];
    for index in (0..300).step_by(25) {
        let mut drawing = drawing_of(&svg, &config);
        drawing.items = vec![drawing.items.swap_remove(index)];
        drawing.tree = crate::drawing::tree::Tree::ungrouped(1);
        let placed = {
            let forced =
                crate::coverage::verdict::Verdict::forced(crate::coverage::verdict::Coverage::Msdf);
            crate::coverage::placed::place(&drawing, &lattice, &[forced])
        };
        let area = placed[0].bounds();
        let contours: Vec<fdsm::shape::Contour> =
            crate::coverage::msdf::contours_for_fdsm(&placed[0].outline);
        let shape = fdsm::shape::Shape { contours };
        let shape = fdsm::shape::Shape::edge_coloring_simple(shape, 0.14, 0).prepare();
        let (width, height) = (area.x1.ceil() as u32, area.y1.ceil() as u32);
        let (left, top) = (area.x0.max(0.0) as u32, area.y0.max(0.0) as u32);
        let start = Instant::now();
        let mut sum = 0.0;
        for y in top..height {
            for x in left..width {
                let p = nalgebra::Point2::new(f64::from(x), f64::from(y));
                let nearest = shape.distance3(p);
                sum += nearest
                    .map(|d| d.signed_pseudo_distance(p))
                    .iter()
                    .sum::<f64>();
            }
        }
        let plain = start.elapsed().as_secs_f64();
        assert!(sum.is_finite() || sum.is_infinite());
        let plain_texels = (width - left) * (height - top);
        let last = std::sync::Mutex::new((Stage::Parse, Instant::now(), 0.0));
        let observer = |stage: Stage| {
            let mut last = last.lock().unwrap();
            if matches!(last.0, Stage::Cells | Stage::Msdf) {
                last.2 += last.1.elapsed().as_secs_f64();
            }
            (last.0, last.1) = (stage, Instant::now());
        };
        let file = pool.install(|| assemble(drawing, None, &config, [0; 32], &observer).unwrap());
        let ours = last.lock().unwrap().2;
        let our_texels = file.tiles.len() as u32 / 4;
        println!(
            "shape {index}: {} segments, fdsm {:.2} ms for {plain_texels} texels ({:.0} ns), ours {:.2} ms for {our_texels} ({:.0} ns)",
            placed[0].outline.segments().count(),
            plain * 1e3,
            plain * 1e9 / f64::from(plain_texels),
            ours * 1e3,
            ours * 1e9 / f64::from(our_texels.max(1)),
        );
        total = [total[0] + plain, total[1] + ours];
        texels = [texels[0] + plain_texels, texels[1] + our_texels];
    }
    println!(
        "all: fdsm {:.1} ms, {:.0} ns a texel; ours {:.1} ms, {:.0} ns a texel",
        total[0] * 1e3,
        total[0] * 1e9 / f64::from(texels[0]),
        total[1] * 1e3,
        total[1] * 1e9 / f64::from(texels[1]),
    );
}
