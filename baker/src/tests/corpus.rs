//! Files of the corpus, hostile ones too, become drawings. Slow: runs with `VTEX_SLOW=1` where the
//! folder named by `VTEX_CORPUS` exists.

#![expect(clippy::print_stdout, reason = "says when there is no corpus")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::{BakeConfig, Mode, Resources, bake, pipeline::draw, testing::corpus_root};

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
