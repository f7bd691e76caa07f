//! Curve records made by hand.

use vtex_format::{CurveHeader, DistanceOutline, EntryKind, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

use crate::builder::{
    MARGIN, Segment, TEXELS, paint, push_entries, push_record, row_of, set_record,
};

const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];

/// Closed lines through `corners`.
fn polygon(corners: &[[f32; 2]]) -> Vec<Segment> {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(&a, &b)| vec![a, b])
        .collect()
}

fn square() -> Vec<Segment> {
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
    let words = pack(file, &options);
    let columns = file.meta.grid.size_cells[0] as f32;
    move |u, v| Sampler::new(&words).sample([u, v], [width / columns, 0.0, 0.0, width])[3]
}

/// Points of a raster that hits no edge of the shapes here.
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

#[test]
fn a_ramp_is_the_box_average_of_an_edge() {
    let file = file_of(&square(), CurveHeader::default());
    for width in [0.01_f32, 0.1, 0.3] {
        let got = alpha(&file, FilterMode::Footprint, width);
        for i in 0..=100 {
            let u = 0.1 + 0.3 * i as f32 / 100.0;
            let expected = ((u - 0.25) / width + 0.5).clamp(0.0, 1.0);
            let tolerance = 2e-5 / width;
            assert!(
                (got(u, 0.5) - expected).abs() <= tolerance,
                "{width} at {u}"
            );
        }
    }
}

#[test]
fn paper_mode_is_equation_1() {
    let mut file = file_of(&square(), CurveHeader::default());
    file.meta.sampler.smoothing = 0.2;
    let got = alpha(&file, FilterMode::Paper, 0.1);
    for i in 0..=100 {
        let u = 0.15 + 0.2 * i as f32 / 100.0;
        // The distance range is four texels, a cell.
        let m = f64::from(u - 0.25) + 0.5;
        let expected = crate::formula::smoothstep(0.3, 0.7, m);
        assert!((f64::from(got(u, 0.5)) - expected).abs() < 2e-4, "at {u}");
    }
}

#[test]
fn beyond_its_reach_a_record_knows_the_side() {
    let wide = polygon(&[[0.0, 0.0], [0.0, 0.6], [0.6, 0.6], [0.6, 0.0]]);
    let file = file_of(&wide, CurveHeader::default());
    let got = alpha(&file, FilterMode::Footprint, 100.0);
    for (u, v, distance) in [
        (0.3, 0.3, 0.3),
        (0.95, 0.5, -0.35),
        (0.55, 0.3, 0.05),
        (0.7, 0.3, -0.1),
    ] {
        let expected = if f32::abs(distance) > MARGIN {
            f32::from(u8::from(distance > 0.0))
        } else {
            0.5 + distance / 100.0
        };
        assert!(
            (got(u, v) - expected).abs() < 1e-5,
            "{} at ({u}, {v})",
            got(u, v)
        );
    }
}

/// A circle about (0.5, 0.5): eight quadratics, none of which turns back in x or y.
fn circle() -> Vec<Segment> {
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
    let got = alpha(&file, FilterMode::Footprint, 0.2);
    for (u, v) in raster() {
        let expected = ((0.4 - radius(u, v)) / 0.2 + 0.5).clamp(0.0, 1.0);
        assert!((got(u, v) - expected).abs() < 0.011, "at ({u}, {v})");
    }
}

#[test]
fn a_star_follows_its_fill_rule() {
    let corner = |i: i32| {
        let angle = i as f32 * 0.8 * std::f32::consts::PI - 0.5 * std::f32::consts::PI;
        [0.5 + 0.45 * angle.cos(), 0.5 + 0.45 * angle.sin()]
    };
    let star = polygon(&[0, 1, 2, 3, 4].map(corner));
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

/// A bar from the middle of the first cell to that of the second. The second record has the bar's
/// left part as two steps of the winding beside its box.
#[test]
fn cells_join_without_a_seam() {
    let mut file = row_of(2);
    let [top, bottom] = [0.3, 0.7];
    let left = push_record(
        &mut file,
        CurveHeader::default(),
        &[],
        &[
            vec![[0.5, top], [0.5, bottom]],
            vec![[0.5, top], [1.25, top]],
            vec![[0.5, bottom], [1.25, bottom]],
        ],
    );
    let right = push_record(
        &mut file,
        CurveHeader::default(),
        &[(top, 1), (bottom, -1)],
        &[
            vec![[0.5, bottom], [0.5, top]],
            vec![[-0.25, top], [0.5, top]],
            vec![[-0.25, bottom], [0.5, bottom]],
        ],
    );
    set_record(&mut file, 0, left, RED);
    set_record(&mut file, 1, right, RED);
    check_inside(&file, |u, v| {
        Some((0.25..0.75).contains(&u) && (top..bottom).contains(&v))
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

#[test]
fn an_outline_goes_around_curves_as_around_tiles() {
    let mut file = file_of(&square(), CurveHeader::default());
    let ring = paint(&mut file, [0.0, 1.0, 0.0, 1.0]);
    // An eighth of a cell.
    file.meta.sampler.outline = Some(DistanceOutline {
        width_texels: TEXELS as f32 / 8.0,
        paint: ring,
    });
    let words = pack(&file, &PackOptions::default());
    let sampler = Sampler::new(&words);
    for (u, v) in raster() {
        let outside = [u, v].map(|x| (0.25 - x).max(x - 0.75).max(0.0));
        let distance = outside[0].hypot(outside[1]);
        let expected = match distance {
            0.0 => [1.0, 0.0],
            d if d < 0.125 => [0.0, 1.0],
            _ => [0.0, 0.0],
        };
        let [r, g, ..] = sampler.sample([u, v], [0.0; 4]);
        assert!(
            [r, g] == expected || (distance - 0.125).abs() < 1e-4,
            "({u}, {v}): {r} {g}"
        );
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
    let words = pack(&file, &PackOptions::default());
    let sampler = Sampler::new(&words);
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
