//! What closed issues promised, on real files.

use std::sync::Arc;

use vtex_baker::{BakeConfig, Resources};
use vtex_format::{Limits, VtexFile, WarningCode, validate};
use vtex_testing::Corpus;
use vtex_truth::comparison::{Comparison, Terms};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// Issue 2: all ten drawings of the kinds of \[SFG22\] Table 1 bake and are valid; those of solid
/// fills and strokes alone reach 35 dB at 512 pixels.
#[test]
fn paper5_bakes_and_looks_right() {
    let Some(corpus) = Corpus::find("the drawings of the kinds of [SFG22]") else {
        return;
    };
    let svgs = corpus.svg_files(&["paper5"]);
    assert_eq!(svgs.len(), 10, "paper5 has ten drawings");
    let mut compared = 0;
    for path in &svgs {
        let svg = std::fs::read(path).expect("the corpus can be read");
        let name = path.display();
        let resources = Resources::default();
        let file = vtex_baker::bake_observed(&svg, &BakeConfig::default(), &resources, &|_| ())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let bytes = file
            .to_bytes()
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(validate(&bytes, &Limits::default()), [], "{name}");
        if only_solid(&file) {
            let psnr_db = psnr_at_1x(&svg, &file);
            assert!(psnr_db >= 35.0, "{name}: {psnr_db} dB");
            compared += 1;
        }
    }
    assert!(
        compared >= 5,
        "only {compared} drawings are solid fills and strokes"
    );
}

fn only_solid(file: &VtexFile) -> bool {
    let provenance = file.provenance.as_ref().expect("bakes have provenance");
    let patched = |code| matches!(code, WarningCode::RasterPatch | WarningCode::MissingFont);
    !provenance
        .warnings
        .iter()
        .any(|warning| patched(warning.code))
}

fn psnr_at_1x(svg: &[u8], file: &VtexFile) -> f64 {
    let reference = Reference::parse(svg, Arc::default(), Edges::Crisp).expect("an SVG");
    let terms = Terms {
        longer_px: 512,
        spp: 16,
        region_uv: vtex_truth::picture::POINTS,
        windows: vtex_truth::comparison::WINDOWS,
        mask: false,
    };
    let packed = vtex_shaders::pack(file, &canvas_options(FilterMode::Point));
    let shooter = Shooter::Cpu { packed };
    let report = Comparison::new(&reference, terms)
        .and_then(|comparison| comparison.measure(1.0, |shot| shooter.shoot(shot)))
        .expect("the reference can be drawn");
    report.worst().difference.psnr_db
}
