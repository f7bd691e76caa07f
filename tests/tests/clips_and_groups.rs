//! Clips, groups, masks and blend modes: the twin against a reference over random trees.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use vtex_format::{BlendMode, VtexFile};
use vtex_shaders::cpu::{Sampler, color};
use vtex_shaders::{FilterMode, PackOptions, pack};
use vtex_tests::clips_and_groups::{
    Clip, Compositing, Drawing, Group, Lens, Node, Part, Wants, lattice, polygon_record,
};
use vtex_tests::random::Random;

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

/// What a drawing shows at `uv`.
fn expected_color(drawing: &Drawing, uv: [f32; 2]) -> [f64; 4] {
    let x = uv[0] * CELLS as f32;
    let column = x.floor().clamp(0.0, (CELLS - 1) as f32);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a column"
    )]
    let cell = &drawing.cells[column as usize];
    Lens::new(drawing, [x - column, uv[1]]).color(cell)
}

/// The mean of what a drawing shows at `places`.
fn mean(drawing: &Drawing, places: &[[f32; 2]]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for &place in places {
        let color = expected_color(drawing, place);
        sum = std::array::from_fn(|i| sum[i] + color[i]);
    }
    sum.map(|channel| channel / places.len() as f64)
}

/// How lookups at random places of a drawing fared.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    /// The largest difference of any channel.
    worst: f64,
    /// The largest as a share of one sample.
    samples: f64,
    /// Lookups that differ by more than [`TOLERANCE`].
    off: u64,
    /// Colours.
    colors: u64,
}

/// `axes` are those of the footprint, in cells.
fn tally(drawing: &Drawing, file: &VtexFile, options: &PackOptions, axes: [f32; 4]) -> Tally {
    let packed = pack(file, options);
    let sampler = Sampler::new(&packed);
    let mut r = Random::new(7);
    let columns = CELLS as f32;
    let footprint = [axes[0] / columns, axes[1], axes[2] / columns, axes[3]];
    let mut tally = Tally::default();
    let mut seen = Vec::new();
    for _ in 0..LOOKUPS {
        let uv = [r.unit(), r.unit()];
        let got = sampler.sample(uv, footprint);
        let places = match options.filter {
            FilterMode::Point => vec![uv],
            _ => sampler.places(uv, footprint),
        };
        let expected = mean(drawing, &places);
        let differences = got
            .iter()
            .zip(expected)
            .map(|(got, expected)| (f64::from(*got) - expected).abs());
        let difference = differences.fold(0.0, f64::max);
        tally.worst = tally.worst.max(difference);
        tally.samples = tally.samples.max(difference * places.len() as f64);
        tally.off += u64::from(difference > TOLERANCE);
        if !seen.contains(&got) {
            seen.push(got);
        }
    }
    tally.colors = seen.len() as u64;
    tally
}

/// What a lookup may differ by: packed paints have 16 bits a channel, half a step is 7.6e-6, and
/// colours are decoded where the curve is up to 2.3 times as steep.
const TOLERANCE: f64 = 2e-5;
/// Samples of a footprint that lie within rounding of an edge, which may be found on either side.
const STRAY_SAMPLES: f64 = 1.0;

/// Checks drawings before and after their cells are halved; the file's own validator finds nothing.
fn check(wants: Wants, filter: FilterMode, axes: [f32; 4], drawings: u64) {
    let [colors, off] = [const { AtomicU64::new(0) }; 2];
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
            let tally = tally(&drawing, &file, &options, axes);
            colors.fetch_add(tally.colors, Ordering::Relaxed);
            off.fetch_add(tally.off, Ordering::Relaxed);
            let sound = match filter {
                FilterMode::Point => tally.worst <= TOLERANCE,
                _ => tally.samples <= STRAY_SAMPLES + TOLERANCE,
            };
            assert!(
                sound,
                "drawing {seed}, {wants:?}, {options:?}, {axes:?}: {tally:?}"
            );
        }
    });
    let [colors, off] = [colors, off].map(AtomicU64::into_inner);
    let least = 5 * drawings * u64::from(CELLS);
    assert!(colors > least, "hardly a picture: {wants:?}");
    let lookups = 5 * drawings * u64::from(LOOKUPS);
    assert!(
        off * 1000 <= lookups,
        "{wants:?}, {axes:?}: {off} of {lookups} differ"
    );
}

#[test]
fn points_show_what_trees_say() {
    for wants in [CLIPS, GROUPS, BOTH, ALL] {
        check(wants, FilterMode::Point, [0.0; 4], 40);
    }
}

#[test]
fn footprints_show_what_trees_say() {
    // Squares, and one that is sheared and wider than a cell.
    let footprints = [
        [0.01, 0.0, 0.0, 0.01],
        [0.1, 0.0, 0.0, 0.1],
        [0.3, 0.0, 0.0, 0.3],
        [1.3, 0.2, 0.1, 0.15],
    ];
    for wants in [CLIPS, GROUPS, BOTH, ALL] {
        for axes in footprints {
            check(wants, FilterMode::Footprint, axes, 4);
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

/// The edge of a clip through a paint that fills the cell is the average in linear light, however
/// many clips have that edge.
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
    for clip in [half(), twice, either] {
        let group = Group {
            clip: Some(clip),
            compositing: None,
            body: vec![shape.clone()],
        };
        let file = half_plane(vec![Node::Group(group)]).file();
        let options = PackOptions {
            filter: FilterMode::Footprint,
            ..PackOptions::default()
        };
        let packed = pack(&file, &options);
        let sampler = Sampler::new(&packed);
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
                let expected = c * f64::from(full);
                // The edge may lie anywhere between two of 32 samples, which move; the lattice holds
                // the middle to half a unit.
                let tolerance = 1.0 / 32.0 + 3e-4;
                assert!(
                    (f64::from(got) - expected).abs() < tolerance,
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
        let group = Group {
            clip: None,
            compositing: Some(Compositing {
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
        let file = half_plane(vec![ground, Node::Group(group)]).file();
        let packed = pack(&file, &PackOptions::default());
        let sampler = Sampler::new(&packed);
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
            assert!((got - expected).abs() < 2e-5, "{got} {expected}");
        }
        assert!((behind[3] - 0.5).abs() < 1e-5, "{behind:?}");
    }
}
