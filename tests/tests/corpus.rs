//! No feature of a real file is dropped silently: every file of the corpus looks as resvg paints
//! it, pixel by pixel, or a warning of it names the feature that makes the difference.
//!
//! Slow: wants `VTEX_SLOW=1` and the corpus that `VTEX_CORPUS` names. `VTEX_FILTER` takes only files
//! whose path contains it.

#![expect(clippy::print_stdout, reason = "the figures are wanted")]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::collections::BTreeSet;
use std::path::PathBuf;

use rayon::prelude::*;
use vtex_baker::{BakeConfig, Resources, bake};
use vtex_format::{COVERAGE_IMAGE, EMBEDDED_SOURCE, VtexFile, Warning, WarningCode};
use vtex_shaders::{cpu, pack};
use vtex_testing::{Corpus, slow_only};
use vtex_tests::fonts;
use vtex_truth::picture::{POINTS, Picture, Shot, View, fit_size};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{FilterMode, canvas_options};

/// Pixels of the pictures' longer side.
const LONGER_PX: u32 = 256;
/// Samples a pixel of ours, and along each side of a pixel of the truth.
const SPP: u32 = 64;
const TRUTH_SAMPLES: u32 = 8;
/// A pixel differs when a channel, in linear light over white, is this far outside the range of the
/// nine pixels around it in the other picture: noise, edges a fraction of a pixel off and slivers
/// that fall between the samples do not count, nor does what is nearly as dark as its ground.
const APART: f32 = 0.08;
/// Pixels that may differ: dots smaller than the samples' distance.
const FEW: usize = 3;
/// Files that differ without a warning, and why; they have to differ.
const OFF: [(&str, &str); 15] = [
    ("matplotlib__fill_between_interpolate.svg", HATCH),
    ("matplotlib__hatching.svg", HATCH),
    ("batik__patternRegionA.svg", HATCH),
    ("batik__cssMedia.svg", HATCH),
    ("inkscape-other__patterns.svg", HATCH),
    ("batik__batikFX.svg", HATCH),
    (
        "batik__textRotate.svg",
        "layers within layers (decision 0009)",
    ),
    ("matplotlib__patheffect3.svg", THIN),
    ("tree_branches_and_roots_01.svg", THIN),
    ("svgpan__tiger.svg", THIN),
    ("inkscape-examples__l-systems.svg", THIN),
    ("inkscape-examples__text-on-path.svg", THIN),
    ("batik__fontGlyphsD.svg", SMALL),
    ("batik__smallFonts.svg", SMALL),
    ("batik__textEffect3.svg", SMALL),
];
const HATCH: &str = "resvg's patterns, whose tiles it rounds to whole pixels";
const SMALL: &str = "7 to 10 pixels of small text, not looked into";
const THIN: &str = "up to 14 pixels of lines thinner than the samples' distance";
/// As the baker's documentation asks for.
const STACK_BYTES: usize = 64 << 20;

#[test]
fn differences_from_resvg_are_explained() {
    let untested = "every file of the corpus against resvg";
    if !slow_only(untested) {
        return;
    }
    let Some(corpus) = Corpus::find(untested) else {
        return;
    };
    let mut files = corpus.drawings();
    let wanted = std::env::var("VTEX_FILTER").unwrap_or_default();
    files.retain(|path| path.to_string_lossy().contains(&wanted));
    assert!(!files.is_empty(), "no path contains {wanted}");
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES);
    let look = |path: &PathBuf| {
        let name = corpus.name(path);
        let found = look(&std::fs::read(path).unwrap());
        match (found, OFF.iter().find(|(end, _)| name.ends_with(end))) {
            (Err(_), Some(_)) => Ok(()),
            (Ok(()), Some((_, why))) => Err(format!("{name}: nothing differs; not {why}?")),
            (found, None) => found.map_err(|why| format!("{name}: {why}")),
        }
    };
    let pool = pool.build().unwrap();
    let results: Vec<Result<(), String>> = pool.install(|| files.par_iter().map(look).collect());
    let wrong: Vec<&String> = results
        .iter()
        .filter_map(|result| result.as_ref().err())
        .collect();
    println!(
        "{} files, {} with differences that no warning explains",
        files.len(),
        wrong.len()
    );
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// An error where the file does not bake or a difference has no explanation.
fn look(svg: &[u8]) -> Result<(), String> {
    let resources = Resources {
        fonts: fonts::library(),
        ..Resources::default()
    };
    let file = bake(svg, &BakeConfig::default(), &resources).map_err(|error| error.to_string())?;
    let reference = Reference::parse(svg, fonts::library(), Edges::Crisp)?;
    let size_px = fit_size(reference.canvas_size(), LONGER_PX);
    let truth = reference.render_with(View::WHOLE, size_px, TRUTH_SAMPLES);
    let shot = Shot {
        view: View::WHOLE,
        size_px,
        spp: SPP,
        region_uv: POINTS,
    };
    let packed = pack(&file, &canvas_options(FilterMode::Point));
    let sampler = cpu::Sampler::new(&packed);
    let ours = shot.shoot(|uv, _| sampler.sample(uv, [0.0; 4]));
    explain(&file, &differing(&truth.unwrap(), &ours))
}

/// Pixels that differ, as the uv of their centres.
fn differing(truth: &Picture, ours: &Picture) -> Vec<[f32; 2]> {
    let [width, height] = truth.size_px;
    let over_white = |&[r, g, b, a]: &[f32; 4]| [r, g, b].map(|c| c + 1.0 - a);
    let rgb: [Vec<[f32; 3]>; 2] =
        [truth, ours].map(|picture| picture.pixels.iter().map(over_white).collect());
    let at = |of: usize, x: u32, y: u32| rgb[of][(y * width + x) as usize];
    let strange = |of: usize, x: u32, y: u32| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = || x.saturating_sub(1)..(x + 2).min(width);
        let [mut low, mut high] = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
        for around in rows.flat_map(|y| columns().map(move |x| at(1 - of, x, y))) {
            low = std::array::from_fn(|c| low[c].min(around[c]));
            high = std::array::from_fn(|c| high[c].max(around[c]));
        }
        let mine = at(of, x, y);
        (0..3).any(|c| mine[c] < low[c] - APART || mine[c] > high[c] + APART)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    pixels
        .filter(|&[x, y]| strange(0, x, y) || strange(1, x, y))
        .map(|[x, y]| {
            [
                (x as f32 + 0.5) / width as f32,
                (y as f32 + 0.5) / height as f32,
            ]
        })
        .collect()
}

/// A raster patch explains what differs within it, provided that a warning names its feature; an
/// outline that a fallback drew explains any difference. Fonts and images that are missing are
/// missing in both pictures.
fn explain(file: &VtexFile, differing: &[[f32; 2]]) -> Result<(), String> {
    let provenance = file.provenance.as_ref().ok_or("no provenance")?;
    let warned = |code: WarningCode| {
        let of_code = provenance.warnings.iter().filter(move |w| w.code == code);
        of_code
            .map(|w: &Warning| w.feature.as_str())
            .collect::<BTreeSet<_>>()
    };
    let [patches, fallbacks] = [WarningCode::RasterPatch, WarningCode::PathFallback].map(warned);
    let mut rects = Vec::new();
    for (shape, report) in file.shapes.iter().zip(&provenance.shapes) {
        if shape.coverage == COVERAGE_IMAGE {
            let feature = report.source.as_str();
            let known = patches.contains(feature) || fallbacks.contains(feature);
            // An image's own texels are no patch; between them resvg smooths otherwise.
            if !known && feature != EMBEDDED_SOURCE {
                return Err(format!("no warning of a patch because of {feature}"));
            }
            rects.push(shape.bounds_uv);
        }
    }
    let inside = |&[u, v]: &[f32; 2]| {
        let mut rects = rects.iter();
        rects.any(|[left, top, right, bottom]| {
            (*left..=*right).contains(&u) && (*top..=*bottom).contains(&v)
        })
    };
    let unexplained: Vec<_> = differing.iter().filter(|place| !inside(place)).collect();
    if unexplained.len() <= FEW || !fallbacks.is_empty() {
        return Ok(());
    }
    let (count, first) = (unexplained.len(), unexplained[0]);
    Err(format!(
        "{count} pixels differ without a reason, the first at {first:.4?}"
    ))
}

/// A shape that is left out, a feature that is not warned of.
#[test]
fn what_is_missing_is_noticed() {
    let svg = |content: &str| {
        format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{content}</svg>")
    };
    let shown = svg("<circle cx='30' cy='30' r='20'/><path d='M70 70h4v4h-4z' fill='#c00'/>");
    let less = svg("<circle cx='30' cy='30' r='20'/>");
    assert_eq!(look(shown.as_bytes()), Ok(()));
    let reference = |svg: &str| {
        let reference = Reference::parse(svg.as_bytes(), fonts::library(), Edges::Crisp).unwrap();
        reference
            .render_with(View::WHOLE, [256; 2], TRUTH_SAMPLES)
            .unwrap()
    };
    let apart = differing(&reference(&shown), &reference(&less));
    assert!((60..=140).contains(&apart.len()), "{}", apart.len());
    let file = |svg: &str| {
        bake(
            svg.as_bytes(),
            &BakeConfig::default(),
            &Resources::default(),
        )
    };
    let mut file = file(&svg("<filter id='f'><feOffset/></filter>\
        <g filter='url(#f)'><path d='M60 60h20v20h-20z'/></g>"))
    .unwrap();
    assert_eq!(explain(&file, &apart), Ok(()));
    assert!(explain(&file, &[[0.1, 0.1]; 9]).is_err());
    file.provenance.as_mut().unwrap().warnings.clear();
    assert!(explain(&file, &[]).is_err());
}
