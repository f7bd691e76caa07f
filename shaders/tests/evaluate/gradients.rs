//! Gradients: t from the place, a colour from t, and both where entries composite.

use vtex_format::{
    CellWord, CurveHeader, Entry, EntryKind, Features, Gradient, GradientShape, GradientStop,
    SpecKey, Spread, VtexFile,
};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

use crate::builder::{paint, push_entries, push_record, row_of};
use crate::curves::circle;
use crate::formula::{self, Rgba, Term};
use crate::{FILTERS, check};

const SPREADS: [Spread; 3] = [Spread::Pad, Spread::Reflect, Spread::Repeat];
/// Places that lie nearer than this to a jump of a colour are passed over.
const NEAR: f64 = 1e-4;

fn stop(offset: f32, color: [f32; 4]) -> GradientStop {
    GradientStop { offset, color }
}

/// Red, a jump from lime to blue in the middle, half a yellow from 0.75 on.
fn four_stops() -> Vec<GradientStop> {
    vec![
        stop(0.125, [1.0, 0.0, 0.0, 1.0]),
        stop(0.5, [0.0, 1.0, 0.0, 0.75]),
        stop(0.5, [0.0, 0.0, 1.0, 1.0]),
        stop(0.75, [1.0, 1.0, 0.0, 0.5]),
    ]
}

fn gradient_paint(file: &mut VtexFile, gradient: &Gradient) -> u32 {
    file.paints.push(gradient.store(&mut file.gradients));
    file.paints.len() as u32 - 1
}

fn solid_cell(gradient: &Gradient) -> VtexFile {
    let mut file = row_of(1);
    let paint = gradient_paint(&mut file, gradient);
    file.cells[0] = CellWord::Paint { paint }.encode().expect("a small index");
    file
}

fn spread(spread: Spread, t: f64) -> f64 {
    match spread {
        Spread::Pad => t,
        Spread::Repeat => t - t.floor(),
        Spread::Reflect => {
            let t = t - 2.0 * (t / 2.0).floor();
            if t > 1.0 { 2.0 - t } else { t }
        }
    }
}

/// Straight, sRGB-encoded; `None` too near a jump.
fn color_at(gradient: &Gradient, uv: [f64; 2]) -> Option<[f32; 4]> {
    let Some(t) = gradient.shape.t_at(uv) else {
        return Some([0.0; 4]);
    };
    // So far out the colours of a period are as near as roundings of uv.
    if t.abs() > 100.0 {
        return None;
    }
    let t = spread(gradient.spread, t);
    let stops = &gradient.stops;
    let jumps = stops
        .windows(2)
        .filter(|pair| pair[0].offset == pair[1].offset);
    let mut ends: Vec<f64> = jumps.map(|pair| f64::from(pair[0].offset)).collect();
    if gradient.spread == Spread::Repeat {
        ends.extend([0.0, 1.0]);
    }
    if ends.iter().any(|end| (t - end).abs() < NEAR) {
        return None;
    }
    let behind = stops.iter().position(|stop| f64::from(stop.offset) > t);
    Some(match behind {
        Some(0) => stops[0].color,
        None => stops[stops.len() - 1].color,
        Some(right) => {
            let [from, to] = [stops[right - 1], stops[right]];
            let [start, end] = [from.offset, to.offset].map(f64::from);
            let f = (t - start) / (end - start);
            std::array::from_fn(|i| {
                ((1.0 - f) * f64::from(from.color[i]) + f * f64::from(to.color[i])) as f32
            })
        }
    })
}

fn compare(gradient: &Gradient) -> u32 {
    let file = solid_cell(gradient);
    let features = SpecKey::for_file(&file).features;
    assert_eq!(features, Features::GRADIENTS, "a cell's paint counts");
    let packed = pack(&file, &PackOptions::default());
    let sampler = Sampler::new(&packed);
    let mut compared = 0;
    for i in 0..400_u16 {
        let (u, v) = (
            f32::from(i % 20) / 20.0 + 0.013,
            f32::from(i / 20) / 20.0 + 0.027,
        );
        if let Some(color) = color_at(gradient, [u, v].map(f64::from)) {
            let got = sampler.sample([u, v], [0.0; 4]);
            check(got, formula::linear(color), 1e-4);
            compared += 1;
        }
    }
    compared
}

#[test]
fn every_shape_and_spread_shows_what_the_formulas_say() {
    let radial = |distance, focal_radius| GradientShape::Radial {
        circle_from_uv: [3.0, 0.5, -0.4, 2.5, -1.2, -1.4],
        distance,
        focal_radius,
    };
    let shapes = [
        GradientShape::Linear {
            t_from_uv: [2.0, -1.5, 0.125],
        },
        radial(0.0, 0.0),
        radial(0.0, 0.25),
        radial(0.0, 1.75),
        radial(0.5, 0.0),
        radial(0.5, 0.25),
        // The focal point on the end circle, outside of it, and circles of one size.
        radial(1.0, 0.0),
        radial(1.5, 0.25),
        radial(0.75, 1.0),
        // The end circle within the focal one.
        radial(0.5, 2.0),
    ];
    for shape in shapes {
        for spread in SPREADS {
            let stops = four_stops();
            let compared = compare(&Gradient {
                shape,
                spread,
                stops,
            });
            assert!(compared > 380, "{shape:?} {spread:?}: {compared}");
        }
    }
}

#[test]
fn any_number_of_stops_is_searched() {
    for count in [1_u16, 2, 3, 4, 5, 7, 8, 9, 31, 32, 33, 1000] {
        let color = |i: u16| [i % 7, i % 5, i % 3].map(|c| f32::from(c) / 8.0);
        let stops = (0..count).map(|i| {
            let [r, g, b] = color(i);
            stop(f32::from(i) / f32::from(count), [r, g, b, 1.0])
        });
        let gradient = Gradient {
            shape: GradientShape::Linear {
                t_from_uv: [1.25, 0.0, -0.125],
            },
            spread: Spread::Pad,
            stops: stops.collect(),
        };
        assert_eq!(compare(&gradient), 400, "{count}");
    }
}

#[test]
fn of_stops_at_one_offset_the_last_rules_from_there_on() {
    let white = [1.0; 4];
    let gradient = Gradient {
        shape: GradientShape::Linear {
            t_from_uv: [1.0, 0.0, 0.0],
        },
        spread: Spread::Pad,
        stops: vec![
            stop(0.5, [0.0, 0.0, 0.0, 1.0]),
            stop(0.5, [0.5; 4]),
            stop(0.5, white),
        ],
    };
    let packed = pack(&solid_cell(&gradient), &PackOptions::default());
    let sampler = Sampler::new(&packed);
    assert_eq!(sampler.sample([0.5, 0.5], [0.0; 4]), white);
    assert_eq!(sampler.sample([0.5_f32.next_down(), 0.5], [0.0; 4])[0], 0.0);
}

#[test]
fn a_gradient_composites_as_a_colour_does() {
    let gradient = Gradient {
        shape: GradientShape::Linear {
            t_from_uv: [1.0, 0.0, 0.0],
        },
        spread: Spread::Pad,
        stops: four_stops(),
    };
    let (front, back) = ([0.25, 0.5, 1.0, 0.5], [0.5, 0.25, 0.0, 1.0]);
    let mut file = row_of(1);
    let indices = [
        paint(&mut file, front),
        gradient_paint(&mut file, &gradient),
        paint(&mut file, back),
    ];
    let entries = indices.map(|index| Entry {
        kind: EntryKind::Full,
        last: false,
        opaque: index == indices[2],
        index,
        data: 0,
    });
    push_entries(&mut file, 0, &entries);
    let expected = Features::LISTS | Features::TRANSLUCENT | Features::GRADIENTS;
    assert_eq!(SpecKey::for_file(&file).features, expected);
    let term = |color| Term {
        coverage: [1.0, 0.0],
        color: [color; 2],
    };
    for filter in FILTERS {
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        let packed = pack(&file, &options);
        for i in 0..50_u16 {
            let u = (f32::from(i) + 0.3) / 50.0;
            let middle = color_at(&gradient, [f64::from(u), 0.5]).expect("not at the jump");
            let expected: Rgba = formula::composited(&[term(front), term(middle), term(back)]);
            let got = Sampler::new(&packed).sample([u, 0.5], [0.0; 4]);
            check(got, expected, 1e-4);
        }
    }
    file.meta.sampler.mask = true;
    file.entries.truncate(4);
    file.entries[2] |= 1 << 27;
    let packed = pack(&file, &PackOptions::default());
    let got = Sampler::new(&packed).sample([0.9, 0.5], [0.0; 4]);
    // Packed paints have 16 bits a channel.
    check(got, [0.75; 4], 1e-5);
}

/// In footprint mode a gradient is evaluated once a fine cell, at the mean place of the samples there
/// that see it.
#[test]
fn a_footprint_sees_a_gradient_at_the_mean_of_its_samples() {
    let gradient = Gradient {
        shape: GradientShape::Linear {
            t_from_uv: [0.8, -0.5, 0.4],
        },
        spread: Spread::Pad,
        stops: vec![
            stop(0.0, [1.0, 0.1, 0.0, 1.0]),
            stop(1.0, [0.2, 0.3, 1.0, 1.0]),
        ],
    };
    let mut file = row_of(1);
    let entry = Entry {
        kind: EntryKind::Curves,
        last: true,
        opaque: false,
        index: gradient_paint(&mut file, &gradient),
        data: push_record(&mut file, CurveHeader::default(), &[], &circle()),
    };
    push_entries(&mut file, 0, &[entry]);
    let both = [FilterMode::Point, FilterMode::Footprint].map(|filter| {
        let options = PackOptions {
            filter,
            halvings: Some(0),
            ..PackOptions::default()
        };
        pack(&file, &options)
    });
    let [points, footprints] = both.each_ref().map(Sampler::new);
    let mut partial = 0;
    for i in 0..400_u16 {
        let uv = [i % 20, i / 20].map(|k| f32::from(k) / 20.0 + 0.021);
        let axes = [0.13, 0.05, -0.02, 0.09];
        let mut places = footprints.places(uv, axes);
        let all = places.len() as f64;
        places.retain(|&place| points.sample(place, [0.0; 4])[3] > 0.0);
        let count = places.len() as f64;
        let expected = if places.is_empty() {
            [0.0; 4]
        } else {
            let mean = [0, 1].map(|axis| {
                places
                    .iter()
                    .map(|place| f64::from(place[axis]))
                    .sum::<f64>()
                    / count
            });
            let color = color_at(&gradient, mean).expect("no jumps");
            formula::linear(color).map(|channel| channel * count / all)
        };
        // A sample counts as in the middle of its room, which is a quarter of the footprint wide.
        check(footprints.sample(uv, axes), expected, 4e-3);
        partial += u32::from(count > 0.0 && count < all);
    }
    assert!(partial > 50, "{partial}");
}
