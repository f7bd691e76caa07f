//! Curve records made by hand.

use vtex_format::{CurveHeader, DistanceOutline, EntryKind, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

use crate::builder::{Segment, TEXELS, paint, push_entries, push_record, row_of, set_record};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

/// Closed lines through `corners`.
pub(crate) fn polygon(corners: &[[f32; 2]]) -> Vec<Segment> {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(&a, &b)| vec![a, b])
        .collect()
}

pub(crate) fn square() -> Vec<Segment> {
    polygon(&[[0.25, 0.25], [0.25, 0.75], [0.75, 0.75], [0.75, 0.25]])
}

fn file_of(segments: &[Segment], header: CurveHeader) -> VtexFile {
    let mut file = row_of(1);
    let place = push_record(&mut file, header, &[], segments);
    set_record(&mut file, 0, place, RED);
    file
}

/// Alpha at points of a file, all with one footprint width in cells.
fn alpha(file: &VtexFile, filter: FilterMode, width: f32) -> impl Fn(f32, f32) -> f32 + use<> {
    let options = PackOptions {
        filter,
        ..PackOptions::default()
    };
    let packed = pack(file, &options);
    let columns = file.meta.grid.size_cells[0] as f32;
    move |u, v| Sampler::new(&packed).sample([u, v], [width / columns, 0.0, 0.0, width])[3]
}

/// Points of a raster that lie on no edge of the shapes here.
fn raster() -> impl Iterator<Item = (f32, f32)> {
    (0..97).flat_map(|i| (0..97).map(move |j| ((i as f32 + 0.37) / 97.0, (j as f32 + 0.61) / 97.0)))
}

fn check_inside(file: &VtexFile, inside: impl Fn(f32, f32) -> Option<bool>) {
    let got = alpha(file, FilterMode::Point, 0.0);
    let mut counts = [0; 2];
    for (u, v) in raster() {
        if let Some(expected) = inside(u, v) {
            counts[usize::from(expected)] += 1;
            assert_eq!(got(u, v), f32::from(u8::from(expected)), "at ({u}, {v})");
        }
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn a_square_is_exact() {
    let file = file_of(&square(), CurveHeader::default());
    check_inside(&file, |u, v| {
        Some((0.25..0.75).contains(&u) && (0.25..0.75).contains(&v))
    });
}

/// Of an upright edge the 32 samples lie in as many columns, of a level one in eight rows.
#[test]
fn a_footprint_is_the_box_average_of_an_edge() {
    let file = file_of(&square(), CurveHeader::default());
    for width in [0.01_f32, 0.1, 0.3] {
        let got = alpha(&file, FilterMode::Footprint, width);
        for i in 0..=100 {
            // No footprint goes beyond the canvas.
            let x = 0.155 + 0.245 * i as f32 / 100.0;
            let expected = ((x - 0.25) / width + 0.5).clamp(0.0, 1.0);
            // The lattice holds the edge to half a unit.
            let rounding = 2e-5 / width;
            // The edge may lie anywhere between two of 32 samples, which move.
            for got in [got(x, 0.5), got(0.5, x)] {
                assert!(
                    (got - expected).abs() <= 1.0 / 32.0 + rounding,
                    "{width} at {x}: {got}, expected {expected}"
                );
            }
        }
    }
}

/// \[SFG22\] eq. 1 is of distances, which curves do not store.
#[test]
fn in_paper_mode_curves_have_hard_edges() {
    let mut file = file_of(&circle(), CurveHeader::default());
    file.meta.sampler.smoothing = 0.2;
    let [paper, point] = [FilterMode::Paper, FilterMode::Point].map(|f| alpha(&file, f, 0.1));
    for (u, v) in raster() {
        assert_eq!(paper(u, v), point(u, v), "at ({u}, {v})");
    }
}

/// A circle about (0.5, 0.5): eight quadratics, none of which turns back in x or y.
pub(crate) fn circle() -> Vec<Segment> {
    const R: f32 = 0.4;
    let at = |eighth: f32, r: f32| {
        let angle = eighth * std::f32::consts::FRAC_PI_4;
        [0.5 + r * angle.cos(), 0.5 + r * angle.sin()]
    };
    let control = R / std::f32::consts::FRAC_PI_8.cos();
    (0..8)
        .map(|i| i as f32)
        .map(|i| vec![at(i, R), at(i + 0.5, control), at(i + 1.0, R)])
        .collect()
}

#[test]
fn a_circle_of_quadratics() {
    let file = file_of(&circle(), CurveHeader::default());
    // Eight quadratics through the circle stay within 0.002 of it at this radius.
    let radius = |u: f32, v: f32| (u - 0.5).hypot(v - 0.5);
    check_inside(&file, |u, v| {
        let off = 0.4 - radius(u, v);
        (off.abs() > 0.002).then_some(off > 0.0)
    });
    let width = 0.2_f32;
    let got = alpha(&file, FilterMode::Footprint, width);
    let (mut worst, mut squares, mut count) = (0.0_f32, 0.0, 0.0);
    let on_canvas = |(u, v): &(f32, f32)| [u, v].iter().all(|x| (0.1..0.9).contains(*x));
    for (u, v) in raster().filter(on_canvas) {
        let along = |x: f32, i: u8| x + width * ((f32::from(i) + 0.5) / 32.0 - 0.5);
        let inside = |(i, j): &(u8, u8)| radius(along(u, *i), along(v, *j)) < 0.4;
        let places = (0..32).flat_map(|i| (0..32).map(move |j| (i, j)));
        let expected = places.filter(inside).count() as f32 / 1024.0;
        let error = (got(u, v) - expected).abs();
        worst = worst.max(error);
        squares += error * error;
        count += 1.0;
    }
    let rms = (squares / count).sqrt();
    // Four of 32 samples.
    assert!(worst < 4.0 / 32.0 && rms < 0.02, "{worst} {rms}");
}

/// Five corners, each joined to the next but one.
pub(crate) fn star() -> Vec<Segment> {
    let corner = |i: i32| {
        let angle = i as f32 * 0.8 * std::f32::consts::PI - 0.5 * std::f32::consts::PI;
        [0.5 + 0.45 * angle.cos(), 0.5 + 0.45 * angle.sin()]
    };
    polygon(&[0, 1, 2, 3, 4].map(corner))
}

#[test]
fn a_star_follows_its_fill_rule() {
    let star = star();
    for even_odd in [false, true] {
        let header = CurveHeader {
            even_odd,
            ..CurveHeader::default()
        };
        let got = alpha(&file_of(&star, header), FilterMode::Point, 0.0);
        assert_eq!(
            got(0.5, 0.5),
            if even_odd { 0.0 } else { 1.0 },
            "the middle"
        );
        assert_eq!(got(0.5, 0.15), 1.0, "a tip");
        assert_eq!(got(0.05, 0.95), 0.0, "a corner of the cell");
    }
}

/// Heights of the bar.
const TOP: f32 = 0.3;
const BOTTOM: f32 = 0.7;

/// A bar from the middle of a cell to that of the next. The second record has the bar's left part as
/// two steps of the winding beside its box.
pub(crate) fn set_bar(file: &mut VtexFile, cells: [usize; 2], color: [f32; 4]) {
    let left = push_record(
        file,
        CurveHeader::default(),
        &[],
        &[
            vec![[0.5, TOP], [0.5, BOTTOM]],
            vec![[0.5, TOP], [1.25, TOP]],
            vec![[0.5, BOTTOM], [1.25, BOTTOM]],
        ],
    );
    let right = push_record(
        file,
        CurveHeader::default(),
        &[(TOP, 1), (BOTTOM, -1)],
        &[
            vec![[0.5, BOTTOM], [0.5, TOP]],
            vec![[-0.25, TOP], [0.5, TOP]],
            vec![[-0.25, BOTTOM], [0.5, BOTTOM]],
        ],
    );
    for (cell, place) in cells.into_iter().zip([left, right]) {
        set_record(file, cell, place, color);
    }
}

#[test]
fn cells_join_without_a_seam() {
    let mut file = row_of(2);
    set_bar(&mut file, [0, 1], RED);
    check_inside(&file, |u, v| {
        Some((0.25..0.75).contains(&u) && (TOP..BOTTOM).contains(&v))
    });
    for filter in [FilterMode::Point, FilterMode::Footprint] {
        let got = alpha(&file, filter, 0.1);
        for v in [0.01, 0.28, 0.32, 0.5, 0.68, 0.71, 0.9] {
            let (before, behind) = (got(0.499_999, v), got(0.500_001, v));
            assert!(
                (before - behind).abs() < 1e-3,
                "{filter:?}: {before} and {behind} at {v}"
            );
        }
    }
}

#[test]
fn a_base_winding_fills_a_cell() {
    for (base_winding, even_odd, expected) in [
        (0, false, 0.0),
        (1, false, 1.0),
        (-2, false, 1.0),
        (-2, true, 0.0),
        (3, true, 1.0),
    ] {
        let header = CurveHeader {
            base_winding,
            even_odd,
            ..CurveHeader::default()
        };
        let file = file_of(&[], header);
        for filter in crate::FILTERS {
            assert_eq!(
                alpha(&file, filter, 0.1)(0.5, 0.5),
                expected,
                "{base_winding} {filter:?}"
            );
        }
    }
}

/// \[SFG22\] eq. 2 is of distances, which curves do not store.
#[test]
fn an_outline_leaves_curves_alone() {
    let plain = file_of(&square(), CurveHeader::default());
    let mut file = plain.clone();
    let ring = paint(&mut file, [0.0, 1.0, 0.0, 1.0]);
    // An eighth of a cell.
    file.meta.sampler.outline = Some(DistanceOutline {
        width_texels: TEXELS as f32 / 8.0,
        paint: ring,
    });
    for filter in crate::FILTERS {
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        let [outlined, plain] = [&file, &plain].map(|file| pack(file, &options));
        let [outlined, plain] = [&outlined, &plain].map(Sampler::new);
        for (u, v) in raster() {
            let [got, expected] =
                [outlined, plain].map(|sampler| sampler.sample([u, v], [0.05, 0.0, 0.0, 0.05]));
            assert_eq!(got, expected, "{filter:?} at ({u}, {v})");
        }
    }
}

#[test]
fn curves_and_tiles_share_a_list() {
    let mut file = row_of(1);
    crate::builder::set_list(
        &mut file,
        0,
        &[(crate::builder::Cover::Edge(2.0), [0.0, 1.0, 0.0, 1.0])],
    );
    let tile = vtex_format::Entry::decode([file.entries[0], file.entries[1]]).expect("an entry");
    let place = push_record(&mut file, CurveHeader::default(), &[], &square());
    let curves = vtex_format::Entry {
        kind: EntryKind::Curves,
        last: false,
        opaque: true,
        index: paint(&mut file, RED),
        data: place,
    };
    push_entries(&mut file, 0, &[curves, tile]);
    let packed = pack(&file, &PackOptions::default());
    let sampler = Sampler::new(&packed);
    for (point, expected) in [
        ([0.3, 0.5], [1.0, 0.0]),
        ([0.7, 0.5], [1.0, 0.0]),
        ([0.1, 0.5], [0.0, 0.0]),
        ([0.9, 0.5], [0.0, 1.0]),
    ] {
        let [r, g, ..] = sampler.sample(point, [0.0; 4]);
        assert_eq!([r, g], expected, "at {point:?}");
    }
}
