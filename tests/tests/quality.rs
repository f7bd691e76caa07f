//! Pictures of whole files against the truth: what more samples must do.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::path::Path;
use std::sync::Arc;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::VtexFile;
use vtex_runtime::FilterMode;
use vtex_shaders::{PackOptions, cpu, pack};
use vtex_truth::comparison::{Comparison, Terms};
use vtex_truth::reference::{Edges, Reference};

/// What four times the samples must gain at least, dB. Noise along edges gives 4.5.
const GAIN_DB: f64 = 3.0;

fn drawing(name: &str) -> (Vec<u8>, VtexFile) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/svg")
        .join(name);
    let svg = std::fs::read(path).unwrap();
    let config = BakeConfig {
        max_zoom: 256.0,
        ..BakeConfig::default()
    };
    let file = bake(&svg, &config, &Resources::default()).unwrap();
    (svg, file)
}

fn psnr_db(reference: &Reference, file: &VtexFile, spp: u32, zoom: f64) -> f64 {
    let terms = Terms {
        longer_px: 128,
        spp,
        region_uv: vtex_truth::picture::POINTS,
        windows: vtex_truth::comparison::WINDOWS,
        mask: false,
    };
    let comparison = Comparison::new(reference, terms).unwrap();
    let options = PackOptions {
        filter: FilterMode::Point,
        ..PackOptions::default()
    };
    let packed = pack(file, &options);
    let sampler = cpu::Sampler::new(&packed);
    let shoot =
        |shot: vtex_truth::picture::Shot| Ok(shot.shoot(|uv, axes| sampler.sample(uv, axes)));
    let report = comparison.measure(zoom, shoot).unwrap();
    // Not the worst window: which that is changes with the noise.
    let windows = report
        .windows
        .iter()
        .map(|window| window.difference.psnr_db);
    windows.sum::<f64>() / report.windows.len() as f64
}

/// A lookup that is wrong somewhere - a row of a cell, an edge out of place - is as wrong with more
/// samples; noise is not.
#[test]
fn more_samples_come_nearer_to_the_truth() {
    for name in [
        "paper/peacock.svg",
        "paper/text-27.svg",
        "stroke/tight-curve.svg",
    ] {
        let (svg, file) = drawing(name);
        let reference = Reference::parse(&svg, Arc::default(), Edges::Crisp).unwrap();
        for zoom in [1.0, 8.0, 32.0, 256.0] {
            let [few, many] = [16, 64].map(|spp| psnr_db(&reference, &file, spp, zoom));
            assert!(
                many >= few + GAIN_DB,
                "{name} at {zoom}x: {few:.1} dB, then {many:.1} dB"
            );
        }
    }
}
