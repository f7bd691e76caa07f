//! Files of the corpus, hostile ones too, become drawings. Slow: runs with `VTEX_SLOW=1`.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use vtex_testing::{Corpus, slow_only};

use crate::{BakeConfig, Mode, Resources, bake, pipeline::draw};

/// Files that usvg or resvg do not finish within a minute. Only a limit on the process helps.
const ENDLESS: [&str; 4] = [
    "07_entity_quadratic.svg",
    "13_pattern_bomb.svg",
    "22_giant_path.svg",
    "32_filter_bomb.svg",
];

/// The drawings whose styles usvg does not read as browsers do, and why.
const STYLED: [(&str, &str); 5] = [
    ("flags/flag-icons__pf.svg", "a width in a style"),
    ("games/gnome-mahjongg__keyboard-key-pause.svg", MEDIUM),
    ("games/pychess__bn_3.svg", MEDIUM),
    ("games/pychess__wq.svg", MEDIUM),
    (
        "technical/inkscape-open-symbols__suru-icon-devices.svg",
        MEDIUM,
    ),
];
const MEDIUM: &str = "a font size by its name";

/// The corpus, where slow tests run.
#[track_caller]
fn corpus(untested: &str) -> Option<Corpus> {
    let slow = slow_only(untested);
    slow.then(|| Corpus::find(untested)).flatten()
}

#[test]
fn raster_mode_paints_the_tiger() {
    let Some(corpus) = corpus("the tiger in raster mode") else {
        return;
    };
    let svg = corpus.read("paper5/5_tiger__svgpan__tiger.svg");
    let mip0 = |mode: Mode| {
        let config = BakeConfig {
            mode,
            ..BakeConfig::default()
        };
        let file = bake(&svg, &config, &Resources::default()).unwrap();
        file.images[0].mips[0].clone()
    };
    let (from_shapes, from_raster) = (mip0(Mode::Auto), mip0(Mode::Raster));
    let pairs = from_shapes.iter().zip(&from_raster);
    let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    let rms = (sum / from_shapes.len() as f64).sqrt();
    assert!(rms < 2.5, "{rms} codes apart");
}

#[test]
fn drawings_that_usvg_reads_as_browsers_do_reach_it_untouched() {
    let Some(corpus) = corpus("which drawings the style stage changes") else {
        return;
    };
    let mut touched = Vec::new();
    for file in corpus.drawings() {
        let svg = std::fs::read(&file).unwrap();
        // Compressed and broken ones aside.
        let Ok(text) = String::from_utf8(svg) else {
            continue;
        };
        if crate::styled_text(text.as_bytes(), &Arc::default()).is_ok_and(|styled| styled != text) {
            touched.push(corpus.name(&file));
        }
    }
    assert_eq!(touched, STYLED.map(|(name, _)| name));
}

#[test]
fn hostile_files_end_in_a_drawing_or_an_error() {
    let Some(corpus) = corpus("hostile files") else {
        return;
    };
    let mut report = String::new();
    for file in corpus.svg_files(&["hostile"]) {
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
                crate::drawing::Item::Image(patch) => patch.rect.is_finite(),
                crate::drawing::Item::Clip(clip) => clip.outline.is_finite(),
            });
            assert!(finite, "{name}");
        }
    }
}
