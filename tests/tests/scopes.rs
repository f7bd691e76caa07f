//! Clips, groups, masks and blend modes: the twin against a reference over random trees.

use rayon::prelude::*;
use vtex_format::VtexFile;
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};
use vtex_tests::random::Random;
use vtex_tests::scopes::{Drawing, Lens, Wants};

/// Trees a drawing.
const CELLS: u32 = 16;
/// Lookups of each packing of a drawing.
const LOOKUPS: u32 = 600;

const CLIPS: Wants = Wants {
    clips: true,
    groups: false,
    blends: false,
};
const GROUPS: Wants = Wants {
    clips: false,
    groups: true,
    blends: false,
};
const BOTH: Wants = Wants {
    clips: true,
    groups: true,
    blends: false,
};
const ALL: Wants = Wants {
    clips: true,
    groups: true,
    blends: true,
};

/// The largest difference of any channel at random places of a drawing.
fn worst(drawing: &Drawing, file: &VtexFile, options: &PackOptions, width: f32) -> f64 {
    let words = pack(file, options);
    let sampler = Sampler::new(&words);
    let mut r = Random::new(7);
    let columns = CELLS as f32;
    let mut worst = 0.0_f64;
    let mut shown = Vec::new();
    for _ in 0..LOOKUPS {
        let uv = [r.unit(), r.unit()];
        let footprint = [width / columns, 0.0, 0.0, width];
        let got = sampler.sample(uv, footprint);
        let x = uv[0] * columns;
        let q = [x - x.floor(), uv[1]];
        let cell = &drawing.cells[x as usize];
        let expected = Lens::new(drawing, q, width).color(cell);
        let differences = got
            .iter()
            .zip(expected)
            .map(|(got, expected)| (f64::from(*got) - expected).abs());
        worst = differences.fold(worst, f64::max);
        if !shown.contains(&got) {
            shown.push(got);
        }
    }
    assert!(
        shown.len() > 20,
        "{} colours are hardly a picture",
        shown.len()
    );
    worst
}

/// What a lookup may differ by: roundings of `f32`, and of distances beside the narrowest ramp.
const POINT_TOLERANCE: f64 = 2e-6;
const RAMP_TOLERANCE: f64 = 5e-5;

/// Checks drawings before and after their cells are halved; the file's own validator finds nothing.
fn check(wants: Wants, filter: FilterMode, width: f32, drawings: u64) {
    let tolerance = match filter {
        FilterMode::Point => POINT_TOLERANCE,
        _ => RAMP_TOLERANCE,
    };
    (0..drawings).into_par_iter().for_each(|seed| {
        let drawing = Drawing::random(seed, CELLS, wants);
        let file = drawing.file();
        assert_eq!(file.check(), [], "drawing {seed} is sound");
        let depths = (0..=4).map(|halvings| PackOptions {
            filter,
            halvings: Some(halvings),
            ..PackOptions::default()
        });
        for options in depths {
            let worst = worst(&drawing, &file, &options, width);
            assert!(
                worst <= tolerance,
                "drawing {seed}, {wants:?}, {options:?}: {worst}"
            );
        }
    });
}

#[test]
fn points_show_what_trees_say() {
    for wants in [CLIPS, GROUPS, BOTH, ALL] {
        check(wants, FilterMode::Point, 0.0, 40);
    }
}

#[test]
fn ramps_show_what_trees_say() {
    for wants in [CLIPS, GROUPS, BOTH, ALL] {
        for width in [0.01, 0.1, 0.3] {
            check(wants, FilterMode::Footprint, width, 12);
        }
    }
}
