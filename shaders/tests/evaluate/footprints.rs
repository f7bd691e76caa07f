//! Footprints of any form: the mean of point lookups at their samples.

use vtex_format::{AddressMode, CurveHeader, Entry, EntryKind, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, Packed, pack};

use crate::builder::{
    Cover, Segment, board_of, paint, push_entries, push_record, row_of, set_list, set_record,
    set_solid,
};
use crate::curves::{circle, polygon, set_bar, square, star};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
const GREY: [f32; 4] = [0.5, 0.5, 0.5, 1.0];
const GLASS: [f32; 4] = [0.2, 0.6, 0.9, 0.4];
const MIST: [f32; 4] = [0.9, 0.8, 0.1, 0.7];

/// Differences of colours that are rounding.
const SAME: f32 = 1e-5;

/// `SplitMix64`, as floats in \[0, 1).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
    }

    /// A length between 0.01 and 1 whose logarithm is uniform, in any direction.
    fn vector(&mut self) -> [f32; 2] {
        let length = 10.0_f32.powf(2.0 * self.unit() - 2.0);
        let angle = self.unit() * std::f32::consts::TAU;
        [length * angle.cos(), length * angle.sin()]
    }
}

/// The forms of footprints.
const FORMS: [&str; 5] = ["upright", "rotated", "sheared", "thin", "without an axis"];

fn footprint(form: &str, r: &mut Random) -> [f32; 4] {
    let [x, y] = r.vector();
    match form {
        "upright" => [x, 0.0, 0.0, y],
        "rotated" => [x, y, -y, x],
        "sheared" => {
            let [p, q] = r.vector();
            [x, y, p, q]
        }
        "thin" => [x, y, -0.01 * y, 0.01 * x],
        _ => [x, y, 0.0, 0.0],
    }
}

/// Lists `shapes`, front to back, in `cell`.
fn set_shapes(file: &mut VtexFile, cell: usize, shapes: &[(&[Segment], [f32; 4])]) {
    let entries: Vec<Entry> = shapes
        .iter()
        .map(|&(segments, color)| Entry {
            kind: EntryKind::Curves,
            last: false,
            opaque: color[3] >= 1.0,
            index: paint(file, color),
            data: push_record(file, CurveHeader::default(), &[], segments),
        })
        .collect();
    push_entries(file, cell, &entries);
}

/// Nine cells of all kinds, one shape across two of them.
fn board() -> VtexFile {
    let mut file = board_of([3, 3]);
    set_shapes(&mut file, 0, &[(&circle(), RED)]);
    set_bar(&mut file, [1, 2], GREY);
    let even_odd = CurveHeader {
        even_odd: true,
        ..CurveHeader::default()
    };
    let place = push_record(&mut file, even_odd, &[], &star());
    set_record(&mut file, 3, place, MIST);
    let stack: [(&[Segment], _); 3] = [(&circle(), GLASS), (&star(), MIST), (&square(), RED)];
    set_shapes(&mut file, 4, &stack);
    set_solid(&mut file, 5, GLASS);
    let tiles = [(Cover::Edge(1.3), MIST), (Cover::Edge(2.6), GREY)];
    set_list(&mut file, 6, &tiles);
    let base = CurveHeader {
        base_winding: -2,
        ..CurveHeader::default()
    };
    let place = push_record(&mut file, base, &[], &circle());
    set_record(&mut file, 7, place, RED);
    file
}

fn packed(file: &VtexFile, filter: FilterMode, halvings: u32) -> Packed {
    let options = PackOptions {
        filter,
        halvings: Some(halvings),
        address: Some([AddressMode::Clamp; 2]),
        ..PackOptions::default()
    };
    pack(file, &options)
}

fn difference(a: [f32; 4], b: [f32; 4]) -> f32 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f32::max)
}

/// The mean of point lookups, and of how many.
fn mean(points: &Sampler<'_>, places: &[[f32; 2]]) -> [f32; 4] {
    let mut sum = [0.0; 4];
    for &place in places {
        let seen = points.sample(place, [0.0; 4]).map(f64::from);
        sum = std::array::from_fn(|i| sum[i] + seen[i]);
    }
    sum.map(|channel| (channel / places.len() as f64) as f32)
}

#[test]
fn a_footprint_is_the_mean_of_points() {
    const LOOKUPS: u32 = 4000;
    let file = board();
    for halvings in [0, 2, 4] {
        let [points, footprints] =
            [FilterMode::Point, FilterMode::Footprint].map(|f| packed(&file, f, halvings));
        let [points, footprints] = [&points, &footprints].map(Sampler::new);
        for form in FORMS {
            let mut r = Random(5);
            let mut off = 0;
            for _ in 0..LOOKUPS {
                let uv = [r.unit(), r.unit()];
                let axes = footprint(form, &mut r);
                let places = footprints.places(uv, axes);
                let got = footprints.sample(uv, axes);
                let by = difference(got, mean(&points, &places));
                // A sample within rounding of an edge may be found on either side.
                off += u32::from(by > SAME);
                let bound = 1.0 / places.len() as f32 + SAME;
                assert!(
                    by <= bound,
                    "{form}, {halvings} halvings: {by} at {uv:?} {axes:?}"
                );
            }
            assert!(off <= LOOKUPS / 1000, "{form}, {halvings} halvings: {off}");
        }
    }
}

#[test]
fn places_fill_the_footprint_evenly() {
    let file = board();
    let packed = packed(&file, FilterMode::Footprint, 0);
    let sampler = Sampler::new(&packed);
    for form in FORMS {
        let mut r = Random(9);
        for _ in 0..500 {
            // Small enough to stay on the canvas.
            let axes = footprint(form, &mut r).map(|x| 0.3 * x);
            let places = sampler.places([0.5, 0.5], axes);
            assert_eq!(places.len(), 32, "{form}");
            let mean = [0, 1].map(|axis| places.iter().map(|p| p[axis]).sum::<f32>() / 32.0);
            // Each lookup moves its samples, by at most half of what lies between two of 32.
            for (axis, mean) in mean.iter().enumerate() {
                let extent = axes[axis].abs() + axes[axis + 2].abs();
                let by = (mean - 0.5).abs();
                assert!(by < extent / 60.0 + 1e-6, "{form} {axes:?}: mean {mean:?}");
            }
            let moment = |f: fn([f32; 2]) -> f32| {
                let each = places
                    .iter()
                    .map(|p| f64::from(f([p[0] - mean[0], p[1] - mean[1]])));
                (each.sum::<f64>() / 32.0) as f32
            };
            // A parallelogram's covariance is a twelfth of the sum of its axes' squares.
            let [ax, ay, bx, by] = axes;
            let expected = [ax * ax + bx * bx, ax * ay + bx * by, ay * ay + by * by];
            let found = [
                moment(|p| p[0] * p[0]),
                moment(|p| p[0] * p[1]),
                moment(|p| p[1] * p[1]),
            ];
            let trace = expected[0] + expected[2];
            for (found, expected) in found.into_iter().zip(expected) {
                let by = (found - expected / 12.0).abs();
                // The columns of lower rows lie a little further right.
                assert!(
                    by < 0.015 * trace + 1e-9,
                    "{form} {axes:?}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn without_a_footprint_curves_show_what_points_do() {
    let file = board();
    let both = [FilterMode::Point, FilterMode::Footprint].map(|f| packed(&file, f, 2));
    let [points, footprints] = both.each_ref().map(Sampler::new);
    let mut r = Random(3);
    for _ in 0..20_000 {
        let uv = [r.unit(), r.unit()];
        let [point, got] = [points, footprints].map(|sampler| sampler.sample(uv, [0.0; 4]));
        assert!(difference(point, got) < SAME, "{uv:?}: {got:?} {point:?}");
    }
}

#[test]
fn what_lies_beyond_the_canvas_does_not_count() {
    let mut file = row_of(1);
    let base = CurveHeader {
        base_winding: 1,
        ..CurveHeader::default()
    };
    let place = push_record(&mut file, base, &[], &[]);
    set_record(&mut file, 0, place, RED);
    let packed = packed(&file, FilterMode::Footprint, 0);
    let sampler = Sampler::new(&packed);
    for uv in [[0.0, 0.5], [1.0, 1.0], [0.5, 0.02]] {
        for side in [0.1, 1.0, 3.0] {
            let axes = [side, 0.0, 0.0, side];
            assert_eq!(sampler.sample(uv, axes), RED, "{uv:?} {side}");
            let inside = |place: &[f32; 2]| place.iter().all(|x| (0.0..=1.0).contains(x));
            let places = sampler.places(uv, axes);
            assert!(places.iter().all(inside), "{uv:?} {side}: {places:?}");
        }
    }
}

/// A lookup inside the canvas shows the canvas, though none of its samples lies there.
#[test]
fn samples_that_miss_the_canvas_do_not_show_what_lies_beyond() {
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
    let mut file = row_of(1);
    set_shapes(&mut file, 0, &[(&polygon(&corners), RED)]);
    let packed = packed(&file, FilterMode::Footprint, 0);
    let sampler = Sampler::new(&packed);
    for (uv, axes) in [
        ([0.01, 0.5], [30.0, 0.0, 0.0, 30.0]),
        // Across a corner of the canvas.
        ([0.016, 0.017], [-0.468, 0.429, -0.0043, -0.0047]),
    ] {
        assert_eq!(sampler.sample(uv, axes), RED, "{uv:?} {axes:?}");
    }
}

/// Two shapes with an edge of lines and quadratics in common show their one colour all over.
#[test]
fn shapes_that_abut_leave_no_seam() {
    let edge: [Segment; 3] = [
        vec![[0.6, 0.0], [0.35, 0.3]],
        vec![[0.35, 0.3], [0.35, 0.55], [0.45, 0.7]],
        vec![[0.45, 0.7], [0.52, 1.0]],
    ];
    let around = |corners: &[[f32; 2]]| {
        let mut sides = polygon(corners);
        // The side that the shared edge takes the place of.
        sides.pop();
        sides
    };
    let left: Vec<Segment> = [
        edge.to_vec(),
        around(&[[0.52, 1.0], [0.0, 1.0], [0.0, 0.0], [0.6, 0.0]]),
    ]
    .concat();
    let back = edge
        .iter()
        .rev()
        .map(|segment| segment.iter().rev().copied().collect());
    let right: Vec<Segment> = [
        back.collect(),
        around(&[[0.6, 0.0], [1.0, 0.0], [1.0, 1.0], [0.52, 1.0]]),
    ]
    .concat();
    for color in [GREY, GLASS] {
        let mut file = row_of(1);
        set_shapes(&mut file, 0, &[(&left, color), (&right, color)]);
        let mut solid = row_of(1);
        set_solid(&mut solid, 0, color);
        for halvings in [0, 3] {
            let [packed, solid] =
                [&file, &solid].map(|file| packed(file, FilterMode::Footprint, halvings));
            let expected = Sampler::new(&solid).sample([0.5; 2], [0.0; 4]);
            let sampler = Sampler::new(&packed);
            let mut r = Random(7);
            for form in FORMS {
                for _ in 0..4000 {
                    // Clear of the canvas' sides, where the shapes end.
                    let uv = [r.unit(), r.unit()].map(|x| 0.25 + 0.5 * x);
                    let axes = footprint(form, &mut r).map(|x| 0.25 * x);
                    let got = sampler.sample(uv, axes);
                    // Sums of 32 colours round; a sample too few or too many is 0.01.
                    assert!(
                        difference(got, expected) < 1e-6,
                        "{form} at {uv:?} {axes:?}: {got:?}, not {expected:?}"
                    );
                }
            }
        }
    }
}
