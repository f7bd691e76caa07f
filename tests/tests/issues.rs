//! What closed issues promised, on real files. The corpus is no part of the project: its folder
//! is named by `VTEX_CORPUS` and is `../shared/corpus` beside the workspace otherwise.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use vtex_baker::{BakeConfig, Resources};
use vtex_format::{Limits, VtexFile, WarningCode, validate};
use vtex_truth::comparison::{Comparison, Terms};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// The corpus, or `None` (said on stderr) when it is absent.
fn corpus() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/corpus");
    let folder = std::env::var_os("VTEX_CORPUS").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    #[expect(clippy::print_stderr, reason = "a test that did not run says so")]
    {
        eprintln!("no corpus at {}: not tested", folder.display());
    }
    None
}

/// Issue 2: all ten drawings of the kinds of \[SFG22\] Table 1 bake and are valid; those of solid
/// fills and strokes alone reach 35 dB at 512 pixels.
#[test]
fn paper5_bakes_and_looks_right() {
    let Some(folder) = corpus().map(|corpus| corpus.join("paper5")) else {
        return;
    };
    let mut svgs: Vec<_> = std::fs::read_dir(&folder)
        .expect("the corpus can be listed")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ext| ext == "svg"))
        .collect();
    svgs.sort();
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
        windows: vtex_truth::comparison::WINDOWS,
        mask: false,
    };
    let words = vtex_shaders::pack(file, &canvas_options(FilterMode::Point));
    let shooter = Shooter::Cpu { words };
    let report = Comparison::new(&reference, terms)
        .and_then(|comparison| comparison.measure(1.0, |shot| shooter.shoot(shot)))
        .expect("the reference can be drawn");
    report.worst().difference.psnr_db
}
