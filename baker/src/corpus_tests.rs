//! Every real file of the corpus becomes a drawing that looks as resvg paints it. Slow: runs with
//! `VTEX_SLOW=1` where the folder named by `VTEX_CORPUS` exists.

#![expect(clippy::print_stdout, reason = "says when there is no corpus")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::picture_tests::{compare, dump};
use crate::testing::corpus_root;
use crate::{BakeConfig, Mode, Resources, bake, draw};

const SIZE: u32 = 512;

/// What usvg or resvg themselves do not finish within a minute; only a process limit helps.
const ENDLESS: [&str; 4] = [
    "07_entity_quadratic.svg",
    "13_pattern_bomb.svg",
    "22_giant_path.svg",
    "32_filter_bomb.svg",
];

fn corpus() -> Option<PathBuf> {
    let slow = std::env::var_os("VTEX_SLOW").is_some_and(|v| v == "1");
    let folder = slow.then(corpus_root).filter(|folder| folder.is_dir());
    if folder.is_none() {
        println!("not run: wants VTEX_SLOW=1 and a corpus");
    }
    folder
}

/// Fonts of the folder named by `VTEX_FONTS`, none without it.
fn resources() -> Resources {
    let mut fonts = usvg::fontdb::Database::new();
    if let Some(folder) = std::env::var_os("VTEX_FONTS") {
        fonts.load_fonts_dir(folder);
    }
    Resources {
        fonts: fonts.into(),
        ..Resources::default()
    }
}

fn svg_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(svg_files(&path));
        } else if path.extension().is_some_and(|e| e == "svg" || e == "svgz") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn real_files_look_as_resvg_paints_them() {
    let Some(folder) = corpus() else { return };
    let files: Vec<_> = svg_files(&folder)
        .into_iter()
        .filter(|f| !f.starts_with(folder.join("hostile")))
        .collect();
    let resources = resources();
    let mut rows: Vec<(f64, String)> = files
        .par_iter()
        .map(|file| {
            let name = file.strip_prefix(&folder).unwrap().display().to_string();
            let svg = std::fs::read(file).unwrap();
            let start = std::time::Instant::now();
            match compare(&svg, &resources, SIZE) {
                Ok(c) => {
                    if c.psnr < 40.0 {
                        dump(&name.replace('/', "_"), &c.ours, &c.theirs);
                    }
                    let ms = start.elapsed().as_millis();
                    let items = c.drawing.items.len();
                    let features: std::collections::BTreeSet<_> = c
                        .drawing
                        .warnings
                        .iter()
                        .map(|w| w.feature.as_str())
                        .collect();
                    (
                        c.psnr,
                        format!("{name}\t{}\t{ms}\t{items}\t{features:?}", c.max),
                    )
                }
                Err(e) => (-1.0, format!("{name}\t{e}")),
            }
        })
        .collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let Ok(dir) = std::env::var("VTEX_DUMP") {
        let mut report = String::new();
        for (psnr, row) in &rows {
            writeln!(report, "{psnr:.1}\t{row}").unwrap();
        }
        std::fs::write(Path::new(&dir).join("corpus.tsv"), report).unwrap();
    }
    let share = |bound: f64| rows.iter().filter(|r| r.0 >= bound).count() * 100 / rows.len();
    assert!(
        share(40.0) >= 80,
        "only {}% of {} files reach 40 dB",
        share(40.0),
        rows.len()
    );
    assert!(
        share(30.0) >= 97,
        "only {}% of {} files reach 30 dB",
        share(30.0),
        rows.len()
    );
}

#[test]
fn raster_mode_paints_the_tiger() {
    let Some(folder) = corpus() else { return };
    let svg = std::fs::read(folder.join("paper5/5_tiger__svgpan__tiger.svg")).unwrap();
    let mip0 = |mode: Mode| {
        let config = BakeConfig {
            mode,
            ..BakeConfig::default()
        };
        let mut file = bake(&svg, &config, &Resources::default()).unwrap();
        file.images.swap_remove(0).mips.swap_remove(0)
    };
    let (from_shapes, from_raster) = (mip0(Mode::Auto), mip0(Mode::Raster));
    let pairs = from_shapes.iter().zip(&from_raster);
    let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    let rms = (sum / from_shapes.len() as f64).sqrt();
    assert!(rms < 2.5, "{rms} codes apart");
}

#[test]
fn hostile_files_end_in_a_drawing_or_an_error() {
    let Some(folder) = corpus() else { return };
    let mut report = String::new();
    for file in svg_files(&folder.join("hostile")) {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        if ENDLESS.contains(&name.as_str()) {
            continue;
        }
        let svg = std::fs::read(&file).unwrap();
        let start = std::time::Instant::now();
        let result = draw(&svg, &BakeConfig::default(), &Resources::default(), &|_| {});
        let text = match &result {
            Ok(drawing) => format!("{} items, {:?}", drawing.items.len(), drawing.warnings),
            Err(e) => e.to_string(),
        };
        writeln!(
            report,
            "{name}\t{}\t{text:.300}",
            start.elapsed().as_millis()
        )
        .unwrap();
        if let Ok(dir) = std::env::var("VTEX_DUMP") {
            std::fs::write(Path::new(&dir).join("hostile.tsv"), &report).unwrap();
        }
        if let Ok(drawing) = &result {
            let finite = drawing.items.iter().all(|item| match item {
                crate::drawing::Item::Shape(shape) => shape.outline.is_finite(),
                crate::drawing::Item::Patch(patch) => patch.rect.is_finite(),
                crate::drawing::Item::Clip(clip) => clip.outline.is_finite(),
            });
            assert!(finite, "{name}");
        }
    }
}
