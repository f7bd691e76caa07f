use std::time::Instant;

use crate::{
    config::{BakeConfig, Stage},
    encode::assemble,
    testing::{Evaluator, corpus_file, drawing_of, paint_exactly, psnr, render, write_png},
};

#[test]
#[ignore = "prints measurements"]
fn measure_tiger() {
    let svg = corpus_file("paper5/5_tiger__svgpan__tiger.svg").unwrap();
    let drawing = drawing_of(&svg);
    let size = [512, 512];
    let exact = paint_exactly(&drawing.items, drawing.canvas_size);
    let full = [0.0, 0.0, 1.0, 1.0];
    let truth = render(&exact, size, full, 8);
    write_png("tiger_exact.png", size, &truth);
    let sampled = render(&exact, size, full, 4);
    println!("exact 16 spp: {:.2} dB", psnr(&truth, &sampled));
    for msdf_size in [512, 768, 1024] {
        let config = BakeConfig {
            msdf_size,
            ..BakeConfig::default()
        };
        let last = std::sync::Mutex::new((Stage::Parse, Instant::now()));
        let observer = |stage: Stage| {
            let mut last = last.lock().unwrap();
            println!(
                "  {:?} {:.1} ms",
                last.0,
                last.1.elapsed().as_secs_f64() * 1e3
            );
            *last = (stage, Instant::now());
        };
        let file = assemble(drawing_of(&svg), None, &config, [0; 32], &observer).unwrap();
        observer(Stage::Encode);
        let evaluator = Evaluator { file: &file };
        let mut entries = 0;
        let mut single = 0;
        for i in 0..100_000 {
            let uv = [f64::from(i % 317) / 317.0, f64::from(i / 317) / 317.0];
            let (word, list, _) = evaluator.entries(uv);
            entries += list.len();
            single += usize::from(!matches!(word, vtex_format::CellWord::List { .. }));
        }
        let picture = render(|uv| evaluator.point(uv), size, full, 4);
        write_png(&format!("tiger_{msdf_size}.png"), size, &picture);
        let zoom = [0.4, 0.3, 0.525, 0.425];
        let zoomed = render(|uv| evaluator.point(uv), size, zoom, 4);
        write_png(&format!("tiger_{msdf_size}_zoom8.png"), size, &zoomed);
        let zoomed_truth = render(&exact, size, zoom, 4);
        println!("issues {:?}", file.check());
        let bytes = file.to_bytes().unwrap();
        let mut bare = file.clone();
        bare.tiles.clear();
        println!(
            "file {} KiB; entries {} cells {} KiB",
            bytes.len() / 1024,
            file.entries.len() * 4 / 1024,
            file.cells.len() * 4 / 1024
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
