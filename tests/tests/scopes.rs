//! Clips, groups, masks and blend modes: the twin against a reference over random trees.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use vtex_format::{BlendMode, VtexFile};
use vtex_shaders::cpu::{Sampler, color};
use vtex_shaders::{FilterMode, PackOptions, pack};
use vtex_tests::random::Random;
use vtex_tests::scopes::{
    Clip, Drawing, Group, Lens, Node, Part, Scope, Wants, lattice, polygon_record,
};

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

/// The largest difference of any channel at random places of a drawing, and how many colours are
/// there.
fn worst(drawing: &Drawing, file: &VtexFile, options: &PackOptions, width: f32) -> (f64, usize) {
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
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a column"
        )]
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
    (worst, shown.len())
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
    let shown = AtomicU64::new(0);
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
            let (worst, colors) = worst(&drawing, &file, &options, width);
            shown.fetch_add(colors as u64, Ordering::Relaxed);
            assert!(
                worst <= tolerance,
                "drawing {seed}, {wants:?}, {options:?}: {worst}"
            );
        }
    });
    let least = 5 * drawings * u64::from(CELLS);
    assert!(shown.into_inner() > least, "hardly a picture: {wants:?}");
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

/// A cell of `nodes`, of which record 0 is a half plane that ends at the cell's middle.
fn half_plane(nodes: Vec<Node>) -> Drawing {
    let end = lattice().box_units();
    let corners = [[0, 0], [end / 2, 0], [end / 2, end], [0, end]];
    Drawing {
        cells: vec![nodes],
        paints: vec![[0.8, 0.2, 0.5, 1.0], [0.1, 0.9, 0.3, 0.5]],
        records: vec![polygon_record(&corners)],
    }
}

fn half() -> Clip {
    let part = Part {
        outline: 0,
        clip: None,
    };
    Clip {
        parts: vec![part],
        also: None,
    }
}

/// The edge of a clip through a paint that fills the cell is the average in linear light.
#[test]
fn a_clips_edge_is_a_linear_average() {
    let width = 0.2;
    let shape = Node::Shape {
        outline: None,
        paint: 0,
    };
    let twice = Clip {
        also: Some(Box::new(half())),
        ..half()
    };
    let either = Clip {
        parts: [half().parts, half().parts].concat(),
        also: None,
    };
    type Power = fn(f64) -> f64;
    let cases: [(Clip, Power); 3] = [
        (half(), |c| c),
        // The same edge twice counts as two that know nothing of each other.
        (twice, |c| c * c),
        (either, |c| 1.0 - (1.0 - c) * (1.0 - c)),
    ];
    for (clip, share) in cases {
        let scope = Scope {
            clip: Some(clip),
            group: None,
            body: vec![shape.clone()],
        };
        let file = half_plane(vec![Node::Scope(scope)]).file();
        let options = PackOptions {
            filter: FilterMode::Footprint,
            ..PackOptions::default()
        };
        let words = pack(&file, &options);
        let sampler = Sampler::new(&words);
        for step in 0..=20 {
            let u = 0.35 + 0.015 * step as f32;
            let got = sampler.sample([u, 0.5], [width, 0.0, 0.0, width]);
            let c = f64::from((0.5 - u) / width + 0.5).clamp(0.0, 1.0);
            for (got, encoded) in got.into_iter().zip([0.8_f32, 0.2, 0.5, 1.0]) {
                let full = if encoded < 1.0 {
                    color::decode_channel(encoded)
                } else {
                    1.0
                };
                let expected = share(c) * f64::from(full);
                // The lattice holds the middle to half a unit.
                assert!(
                    (f64::from(got) - expected).abs() < 3e-4,
                    "{u}: {got} {expected}"
                );
            }
        }
    }
}

/// A group of one shape with half opacity is the shape with half alpha, isolated or not.
#[test]
fn a_groups_opacity_is_alpha() {
    for isolated in [false, true] {
        let group = Scope {
            clip: None,
            group: Some(Group {
                isolated,
                mode: BlendMode::Normal,
                opacity: 0.5,
                masks: Vec::new(),
            }),
            body: vec![Node::Shape {
                outline: Some(0),
                paint: 0,
            }],
        };
        let ground = Node::Shape {
            outline: None,
            paint: 1,
        };
        let file = half_plane(vec![ground, Node::Scope(group)]).file();
        let words = pack(&file, &PackOptions::default());
        let sampler = Sampler::new(&words);
        let [got, behind] = [0.25, 0.75].map(|u| sampler.sample([u, 0.5], [0.0; 4]));
        // 0.5 over 0.5, premultiplied and encoded, then straight and decoded.
        let channel = |front: f32, back: f32| {
            let encoded = 0.5 * front + 0.5 * 0.5 * back;
            0.75 * color::decode_channel(encoded / 0.75)
        };
        let expected = [
            channel(0.8, 0.1),
            channel(0.2, 0.9),
            channel(0.5, 0.3),
            0.75,
        ];
        for (got, expected) in got.into_iter().zip(expected) {
            assert!((got - expected).abs() < 1e-6, "{got} {expected}");
        }
        assert!((behind[3] - 0.5).abs() < 1e-6, "{behind:?}");
    }
}
