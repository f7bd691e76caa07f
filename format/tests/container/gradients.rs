//! Gradients of samples, and what can be wrong with them.

use arbtest::arbitrary::{Result, Unstructured};
use vtex_format::{Features, Gradient, GradientShape, GradientStop, Spread};

use crate::cases::{FileCase, ValueCase, cut};

/// Place of `GRAD` among the sections of the sample.
const GRAD: usize = 4;

/// What the bytes of `GRAD` can lack.
pub(crate) const GRADIENT_FILES: &[FileCase] = &[
    (4001, |s| cut(&mut s[GRAD], 2)),
    (4006, |s| cut(&mut s[GRAD], 4)),
    (4006, |s| drop(s.remove(GRAD))),
];

/// The first gradient has 13 numbers, stops from the third on; the second 23, stops from the
/// eighth on.
pub(crate) const GRADIENT_VALUES: &[ValueCase] = &[
    (3024, |f| {
        f.meta.sampler.outline.as_mut().unwrap().paint = 2;
    }),
    (3033, |f| f.spec.features &= !Features::GRADIENTS),
    (4004, |f| f.paints[2].flags |= 3),
    (4004, |f| f.paints[2].flags |= 8),
    (4004, |f| f.paints[3].color[0] = 1.0),
    (4005, |f| f.gradients[4] = 1.5),
    (4005, |f| f.gradients[3 + 9] = f32::NAN),
    (4006, |f| f.paints[2].data_first = 1),
    (4006, |f| f.paints[2].data_count -= 1),
    (4006, |f| f.paints[2].data_count = 3),
    (4006, |f| f.paints[3].data_count += 5),
    (4006, |f| f.paints[3].data_first = u32::MAX),
    (4006, |f| f.gradients.push(0.0)),
    (4006, |f| f.gradients.clear()),
    (4006, |f| f.paints.swap(2, 3)),
    (4007, |f| f.gradients[2] = f32::INFINITY),
    (4007, |f| f.gradients[13 + 5] = f32::NAN),
    (4007, |f| f.gradients[13 + 6] = -0.5),
    (4007, |f| f.gradients[13 + 7] = f32::INFINITY),
    (4008, |f| f.gradients[3] = 0.75),
    (4008, |f| f.gradients[3 + 5] = 1.25),
    (4008, |f| f.gradients[3] = f32::NAN),
    (4009, |f| f.paints[2].flags ^= 4),
    (4009, |f| f.paints[3].flags ^= 4),
    (4009, |f| f.gradients[13 + 6] = 1.0),
];

/// One along a line, translucent, of two stops; one between circles, opaque, of three.
pub(crate) fn small_gradients() -> [Gradient; 2] {
    let stop = |offset, color| GradientStop { offset, color };
    let radial = GradientShape::Radial {
        circle_from_uv: [2.0, 0.0, 0.0, 2.0, -1.0, -1.0],
        distance: 0.5,
        focal_radius: 0.25,
    };
    [
        Gradient {
            shape: GradientShape::Linear {
                t_from_uv: [1.0, 2.0, -0.5],
            },
            spread: Spread::Pad,
            stops: vec![
                stop(0.0, [1.0, 0.0, 0.0, 1.0]),
                stop(0.5, [0.0, 0.0, 1.0, 0.5]),
            ],
        },
        Gradient {
            shape: radial,
            spread: Spread::Repeat,
            stops: vec![
                stop(0.0, [0.0, 0.25, 0.0, 1.0]),
                stop(0.5, [0.5, 0.0, 1.0, 1.0]),
                stop(0.5, [0.0, 0.0, 1.0, 1.0]),
            ],
        },
    ]
}

/// An arbitrary valid gradient.
pub(crate) fn any_gradient(u: &mut Unstructured<'_>) -> Result<Gradient> {
    let number = |u: &mut Unstructured<'_>| Ok(f32::from(u.arbitrary::<i8>()?) / 16.0);
    let length = |u: &mut Unstructured<'_>| Ok(f32::from(u.arbitrary::<u8>()?) / 64.0);
    let shape = if u.arbitrary()? {
        GradientShape::Linear {
            t_from_uv: [number(u)?, number(u)?, number(u)?],
        }
    } else {
        let [a, b, c] = [number(u)?, number(u)?, number(u)?];
        GradientShape::Radial {
            circle_from_uv: [a, b, -b, a, c, c],
            distance: length(u)?,
            focal_radius: length(u)?,
        }
    };
    let mut offsets = u.arbitrary::<[u8; 4]>()?;
    offsets.sort_unstable();
    let stops = offsets[..u.int_in_range(1..=4)?].iter().map(|&offset| {
        let [r, g, b] = u
            .arbitrary::<[u8; 3]>()?
            .map(|byte| f32::from(byte) / 255.0);
        let alpha = if u.ratio(3, 4)? { 1.0 } else { 0.25 };
        Ok(GradientStop {
            offset: f32::from(offset) / 255.0,
            color: [r, g, b, alpha],
        })
    });
    let stops = stops.collect::<Result<_>>()?;
    Ok(Gradient {
        shape,
        spread: *u.choose(&[Spread::Pad, Spread::Reflect, Spread::Repeat])?,
        stops,
    })
}
