//! Pages with one footprint lookup a pixel: hairlines, small print and abutting shapes.
//!
//! At 512 pixels mips answer (a pixel is a texel of mip 0) or, of files with small mips, the cells.

use std::path::Path;

use vtex_baker::{BakeConfig, Resources, bake};
use vtex_shaders::{Packed, cpu, pack};
use vtex_tests::fonts;
use vtex_truth::comparison::{Comparison, Terms};
use vtex_truth::picture::{Picture, Shot, View};
use vtex_truth::reference::{Edges, Reference};
use vtex_truth::texture::{FilterMode, canvas_options};

/// Texels of mip 0 with which mips answer at 512 pixels, and with which cells do.
const MIP0: [u32; 2] = [512, 64];

fn svg(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/svg/footprint")
        .join(name)
        .with_extension("svg");
    std::fs::read(path).unwrap()
}

/// A drawing in footprint mode, whose mip 0 has so many texels.
fn packed(svg: &[u8], mip0_size: u32) -> Packed {
    let config = BakeConfig {
        mip0_size,
        ..BakeConfig::default()
    };
    let resources = Resources {
        fonts: fonts::library(),
        ..Resources::default()
    };
    let file = bake(svg, &config, &resources).unwrap();
    pack(&file, &canvas_options(FilterMode::Footprint))
}

fn shot(side_px: u32) -> Shot {
    Shot {
        view: View::WHOLE,
        size_px: [side_px; 2],
        spp: 1,
        region_uv: [0.0; 2],
    }
}

fn shoot(packed: &Packed, shot: Shot) -> Picture {
    let sampler = cpu::Sampler::new(packed);
    shot.shoot(|uv, axes| sampler.sample(uv, axes))
}

/// Least PSNR at 1x from mips and from cells and at 4x from cells, dB: 1 or more below what was
/// measured. The worst page, of text, has 41.9, 41.9 and 39.0 dB.
const LEAST_DB: [(&str, [f64; 3]); 6] = [
    ("abutting", [60.0, 58.0, 63.0]),
    ("abutting-halo", [60.0, 61.0, 70.0]),
    ("hairlines", [50.0, 52.0, 55.0]),
    ("hairlines-nearly-level", [60.0, 62.0, 53.0]),
    ("join-seams", [45.0, 52.0, 60.0]),
    ("text-8px", [40.0, 40.0, 37.5]),
];

#[test]
fn pages_come_near_to_the_truth() {
    for (name, least_db) in LEAST_DB {
        let svg = svg(name);
        let reference = Reference::parse(&svg, fonts::library(), Edges::Crisp).unwrap();
        let terms = Terms {
            longer_px: 512,
            spp: 1,
            region_uv: [0.0; 2],
            windows: 1,
            mask: false,
        };
        let comparison = Comparison::new(&reference, terms).unwrap();
        let [mips, cells] = MIP0.map(|texels| packed(&svg, texels));
        let psnr_db = |packed: &Packed, zoom| {
            let report = comparison.measure(zoom, |shot| Ok(shoot(packed, shot)));
            report.unwrap().worst().difference.psnr_db
        };
        let found = [
            psnr_db(&mips, 1.0),
            psnr_db(&cells, 1.0),
            psnr_db(&cells, 4.0),
        ];
        let reached = found.iter().zip(least_db).all(|(db, least)| *db >= least);

        assert!(reached, "{name}: {found:.1?} dB, not {least_db:?}");
    }
}

/// Lines of 60 units in boxes of 80: six widths downwards, six angles to the right.
const WIDTHS: [f64; 6] = [0.02, 0.05, 0.1, 0.25, 0.5, 1.0];

/// Darkness of each box over what its line covers.
fn ink(picture: &Picture) -> [[f64; 6]; 6] {
    let mut ink = [[0.0; 6]; 6];
    let scale = f64::from(picture.size_px[0]) / 480.0;
    for (index, color) in picture.pixels.iter().enumerate() {
        let side = picture.size_px[0] as usize;
        let [x, y] = [index % side, index / side].map(|place| place * 6 / side);
        ink[y][x] += f64::from(1.0 - color[1]) / (60.0 * WIDTHS[y] * scale * scale);
    }
    ink
}

#[test]
fn hairlines_keep_their_ink() {
    let svg = svg("hairlines");
    let cells = packed(&svg, MIP0[1]);
    for side_px in [480, 497, 512] {
        let found = ink(&shoot(&cells, shot(side_px)));
        for (width, row) in WIDTHS.iter().zip(found) {
            // Some 38 samples lie on a line of 0.02 units, and 96 on one of 0.05: measured are 24% and
            // 12% at worst. From 0.1 units on it is 6%.
            let bound = match *width {
                ..0.04 => 0.3,
                ..0.08 => 0.15,
                _ => 0.08,
            };
            let kept = row.iter().all(|ink| (ink - 1.0).abs() < bound);
            assert!(kept, "{width} units at {side_px} pixels: {row:.2?}");
            // Errors are of either sign.
            let mean = row.iter().sum::<f64>() / 6.0;
            let kept = (mean - 1.0).abs() < 0.06;
            assert!(kept, "{width} units at {side_px} pixels: {mean:.3}");
        }
    }
}

/// All shapes have one colour and lie over nothing: within them the picture is that colour.
#[test]
fn abutting_shapes_show_no_seam() {
    let svg = svg("abutting");
    let [mips, cells] = MIP0.map(|texels| packed(&svg, texels));
    for packed in [mips, cells] {
        for side_px in [480, 512, 700, 1333] {
            let picture = shoot(&packed, shot(side_px));
            // A pixel inside the square from 20 to 460 units, and what bilinear lookups reach.
            let inside = |place: u32| {
                let [near, far] = [-2.0, 3.0].map(|reach| f64::from(place) + reach);
                let units = 480.0 / f64::from(side_px);
                near * units > 20.0 && far * units < 460.0
            };
            let thin = (0..side_px * side_px).filter(|index| {
                let place = [index % side_px, index / side_px];
                place.into_iter().all(inside) && picture.pixels[*index as usize][3] < 254.0 / 255.0
            });
            assert_eq!(thin.count(), 0, "pixels that show the ground at {side_px}");
        }
    }
}
