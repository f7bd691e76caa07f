//! Cells, coverage, compositing, outline, mask.

use vtex_format::{DistanceOutline, VtexFile};
use vtex_shaders::FilterMode;

use crate::builder::{Cover, RANGE, TEXELS, paint, row_of, set_list, set_solid, stored};
use crate::formula::{self, Term};
use crate::{FILTERS, check, sample};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREY: [f32; 4] = [0.5, 0.5, 0.5, 1.0];
const GLASS: [f32; 4] = [0.2, 0.6, 0.9, 0.4];
const MIST: [f32; 4] = [0.9, 0.8, 0.1, 0.7];

/// Packed paints have 16 bits a channel.
const PAINT_STEP: f64 = 1e-5;

#[test]
fn empty_and_single_colour_cells() {
    let mut file = row_of(3);
    set_solid(&mut file, 1, GREY);
    set_solid(&mut file, 2, GLASS);
    for filter in FILTERS {
        check(sample(&file, filter, 0.1, 0.0), [0.0; 4], 0.0);
        check(
            sample(&file, filter, 0.5, 0.01),
            formula::linear(GREY),
            PAINT_STEP,
        );
        check(
            sample(&file, filter, 0.9, 0.0),
            formula::linear(GLASS),
            PAINT_STEP,
        );
    }
}

#[test]
fn point_mode_is_a_hard_edge() {
    let mut file = row_of(1);
    // Distances of half texels are not bytes: the stored edge lies within 0.01 texel of 2.
    set_list(&mut file, 0, &[(Cover::Edge(2.0), RED)]);
    for (u, inside) in [(0.0, false), (0.49, false), (0.51, true), (1.0, true)] {
        let expected = if inside {
            formula::linear(RED)
        } else {
            [0.0; 4]
        };
        check(sample(&file, FilterMode::Point, u, 0.0), expected, 0.0);
    }
}

#[test]
fn footprint_mode_is_the_box_average_of_an_edge() {
    let mut file = row_of(1);
    set_list(&mut file, 0, &[(Cover::Edge(2.0), RED)]);
    for width in [0.05_f32, 0.2, 0.4] {
        for u in [0.3_f32, 0.45, 0.5, 0.52, 0.6] {
            let covered = ((u + 0.5 * width - 0.5) / width).clamp(0.0, 1.0);
            let c = f64::from(covered);
            let got = sample(&file, FilterMode::Footprint, u, width);
            // Bytes hold distances to 4 / 255 / 2 texels, the footprint is `width * TEXELS` wide;
            // the edge may lie anywhere between two of its 32 samples, which move.
            let stored = 1.01 * RANGE / 510.0 / (width * TEXELS as f32);
            let tolerance = f64::from(stored + 1.0 / 32.0);
            check(got, [c, 0.0, 0.0, c], tolerance);
        }
    }
}

#[test]
fn footprint_mode_without_footprint_is_point_mode() {
    let mut file = row_of(1);
    set_list(
        &mut file,
        0,
        &[(Cover::Edge(1.3), GLASS), (Cover::Full, GREY)],
    );
    for i in 0..100 {
        let u = i as f32 / 99.0;
        let point = sample(&file, FilterMode::Point, u, 0.0);
        check(
            sample(&file, FilterMode::Footprint, u, 0.0),
            point.map(f64::from),
            1e-5,
        );
    }
}

#[test]
fn paper_mode_is_equation_1() {
    let mut file = row_of(1);
    file.meta.sampler.smoothing = 0.1;
    for distance in [-0.6, -0.3, -0.1, 0.0, 0.2, 0.39] {
        set_list(&mut file, 0, &[(Cover::Uniform(distance), RED)]);
        let m = stored(distance) / f64::from(RANGE) + 0.5;
        let c = formula::smoothstep(0.4, 0.6, m);
        check(
            sample(&file, FilterMode::Paper, 0.5, 0.3),
            [c, 0.0, 0.0, c],
            1e-5,
        );
    }
}

#[test]
fn translucent_paints_composite_on_encoded_values() {
    let mut file = row_of(1);
    set_list(&mut file, 0, &[(Cover::Full, GLASS), (Cover::Full, GREY)]);
    let channel = |front: f32, back: f32| formula::decode(f64::from(0.4 * front + 0.6 * back));
    let expected = [channel(0.2, 0.5), channel(0.6, 0.5), channel(0.9, 0.5), 1.0];
    for filter in FILTERS {
        // Decoded where the curve is up to 2.3 times as steep.
        check(sample(&file, filter, 0.5, 0.0), expected, 2.3 * PAINT_STEP);
    }
}

/// Shapes of constant distance in every mode, with and without outline, against the formulas.
#[test]
fn stacks_follow_the_formulas() {
    let distances = [-2.0, -0.7, -0.2, 0.1, 0.6, 2.0];
    let colors = [RED, GLASS, MIST, GREY];
    for case in 0..4000_usize {
        let pick = |n: usize| case / 7_usize.pow(n as u32 % 4) + n;
        let stack: Vec<_> = (0..1 + case % 4)
            .map(|n| {
                let distance = distances[pick(n) % distances.len()];
                let cover = if pick(n) % 11 == 0 {
                    Cover::Full
                } else {
                    Cover::Uniform(distance)
                };
                (cover, colors[pick(2 * n + 1) % colors.len()])
            })
            .collect();
        let ring = (case % 3 > 0).then_some((0.5, colors[case % colors.len()]));
        check_stack(&stack, ring);
    }
}

fn check_stack(stack: &[(Cover, [f32; 4])], ring: Option<(f32, [f32; 4])>) {
    let mut file = row_of(1);
    file.meta.sampler.smoothing = 0.25;
    set_list(&mut file, 0, stack);
    if let Some((width_texels, color)) = ring {
        let paint = paint(&mut file, color);
        file.meta.sampler.outline = Some(DistanceOutline {
            width_texels,
            paint,
        });
    }
    for filter in FILTERS {
        let terms: Vec<Term> = stack
            .iter()
            .map(|&entry| term(entry, ring, filter))
            .collect();
        let expected = formula::composited(&terms);
        check(sample(&file, filter, 0.5, WIDTH), expected, 2e-5);
        check_mask(&file, filter, expected[3]);
    }
}

/// Footprint in cells of the stacks.
const WIDTH: f32 = 0.3;

fn term(
    (cover, color): (Cover, [f32; 4]),
    ring: Option<(f32, [f32; 4])>,
    filter: FilterMode,
) -> Term {
    let coverage = |d: f64| match filter {
        // The distance is the same all over the footprint.
        FilterMode::Point | FilterMode::Footprint => f64::from(u8::from(d > 0.0)),
        FilterMode::Paper => formula::smoothstep(0.25, 0.75, d / f64::from(RANGE) + 0.5),
    };
    let (grown, ring_color) = ring.unwrap_or_default();
    match cover {
        Cover::Uniform(distance) => {
            let inner = coverage(stored(distance));
            let outer = coverage(stored(distance) + f64::from(grown));
            Term {
                coverage: [inner, outer - inner],
                color: [color, ring_color],
            }
        }
        _ => Term {
            coverage: [1.0, 0.0],
            color: [color, ring_color],
        },
    }
}

fn check_mask(file: &VtexFile, filter: FilterMode, alpha: f64) {
    let mut mask = file.clone();
    mask.meta.sampler.mask = true;
    check(sample(&mask, filter, 0.5, WIDTH), [alpha; 4], 2e-5);
}

#[test]
fn neighbouring_channels_make_a_corner() {
    // Two channels hold two edges, the third the larger: the median is the sharp corner.
    let mut file = row_of(1);
    set_list(&mut file, 0, &[(Cover::Uniform(0.0), RED)]);
    let side = TEXELS + 1;
    for (i, texel) in file.tiles.chunks_exact_mut(4).enumerate() {
        let (x, y) = (i as u32 % side, i as u32 / side);
        let byte = |d: f32| ((d / RANGE + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
        let (right, below) = (byte(x as f32 - 1.5), byte(y as f32 - 1.5));
        texel[..3].copy_from_slice(&[right, below, right.min(below)]);
    }
    let packed = vtex_shaders::pack(&file, &vtex_shaders::PackOptions::default());
    let sampler = vtex_shaders::cpu::Sampler::new(&packed);
    for i in 0..40 {
        for j in 0..40 {
            let (u, v) = ((i as f32 + 0.5) / 40.0, (j as f32 + 0.5) / 40.0);
            let inside = u > 0.375 && v > 0.375;
            let got = sampler.sample([u, v], [0.0; 4])[3];
            assert!(got == f32::from(u8::from(inside)), "({u}, {v}): {got}");
        }
    }
}
