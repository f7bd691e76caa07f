//! Gradients: colours that depend on the place.

use super::paint::PaintRecord;

/// Most stops of a gradient: bounds the search for a lookup's two. A paint with more is malformed.
pub const MAX_GRADIENT_STOPS: u32 = 1 << 15;

/// [`PaintRecord::kind`] of [`GradientShape::Linear`].
const KIND_LINEAR: u32 = 1;
/// [`PaintRecord::kind`] of [`GradientShape::Radial`].
const KIND_RADIAL: u32 = 2;
/// Numbers of `GRAD` a stop takes.
const STOP_NUMBERS: usize = 5;
/// Set in [`PaintRecord::flags`] of a gradient that hides what lies behind it, everywhere.
pub(crate) const FLAG_OPAQUE: u32 = 1 << 2;
/// Bits of [`PaintRecord::flags`] that hold the [`Spread`].
const SPREAD_MASK: u32 = 3;

/// What a gradient shows before its first and behind its last circle or line, SVG's `spreadMethod`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Spread {
    /// The colour of the nearest stop.
    #[default]
    Pad = 0,
    /// The gradient to and fro.
    Reflect = 1,
    /// The gradient again and again.
    Repeat = 2,
}

/// Where a gradient's parameter `t` comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GradientShape {
    /// `t = a u + b v + c`.
    Linear {
        /// a, b, c.
        t_from_uv: [f32; 3],
    },
    /// The circle through the point with the greatest `t` and a radius that is not negative, of
    /// those with centre `(t distance, 0)` and radius `focal_radius + t (1 - focal_radius)`; nothing
    /// where there is none.
    Radial {
        /// a b c d e f: `x = a u + c v + e`, `y = b u + d v + f`.
        circle_from_uv: [f32; 6],
        /// From the centre of the focal circle to that of the end circle, whose radius is 1; at
        /// least 0.
        distance: f32,
        /// Radius of the focal circle, at least 0.
        focal_radius: f32,
    },
}

impl GradientShape {
    /// `distance^2 - (1 - focal_radius)^2` of circles: the leading coefficient of the equation for
    /// `t`. Negative where one circle lies within the other; then every point has a `t`. -1 for a
    /// linear gradient.
    pub fn leading(&self) -> f64 {
        // In f64: the sign decides whether the gradient is opaque, and near 0 the squares cancel.
        match *self {
            Self::Linear { .. } => -1.0,
            Self::Radial {
                distance,
                focal_radius,
                ..
            } => f64::from(distance).powi(2) - (1.0 - f64::from(focal_radius)).powi(2),
        }
    }

    /// `t` at a uv, from the definition; `None` where the gradient shows nothing. Oracles compare
    /// with it what evaluators compute in f32.
    pub fn t_at(&self, [u, v]: [f64; 2]) -> Option<f64> {
        match *self {
            Self::Linear { t_from_uv } => {
                let [a, b, c] = t_from_uv.map(f64::from);
                Some(a * u + b * v + c)
            }
            Self::Radial {
                circle_from_uv,
                distance,
                focal_radius,
            } => {
                let [a, b, c, d, e, f] = circle_from_uv.map(f64::from);
                let p = [a * u + c * v + e, b * u + d * v + f];
                circle(p, f64::from(distance), f64::from(focal_radius))
            }
        }
    }

    /// Whether all numbers are finite, and lengths at least 0.
    pub fn is_sound(&self) -> bool {
        let in_range = match *self {
            Self::Linear { .. } => true,
            Self::Radial {
                distance,
                focal_radius,
                ..
            } => distance >= 0.0 && focal_radius >= 0.0,
        };
        in_range && self.numbers().iter().all(|number| number.is_finite())
    }

    /// Whether [`PaintRecord::kind`] is that of a gradient.
    pub(crate) fn has_kind(kind: u32) -> bool {
        matches!(kind, KIND_LINEAR | KIND_RADIAL)
    }

    fn kind(&self) -> u32 {
        match self {
            Self::Linear { .. } => KIND_LINEAR,
            Self::Radial { .. } => KIND_RADIAL,
        }
    }

    fn numbers(&self) -> Vec<f32> {
        match *self {
            Self::Linear { t_from_uv } => t_from_uv.to_vec(),
            Self::Radial {
                circle_from_uv,
                distance,
                focal_radius,
            } => [&circle_from_uv[..], &[distance, focal_radius]].concat(),
        }
    }
}

/// A colour at a place along a gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientStop {
    /// `t`, in \[0, 1\].
    pub offset: f32,
    /// Straight alpha, sRGB-encoded, each in \[0, 1\].
    pub color: [f32; 4],
}

/// A gradient as a value; [`PaintRecord`] and the numbers of `GRAD` as they are stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Where `t` comes from.
    pub shape: GradientShape,
    /// What it shows beyond its stops.
    pub spread: Spread,
    /// 1 to [`MAX_GRADIENT_STOPS`], their offsets not descending.
    pub stops: Vec<GradientStop>,
}

impl Gradient {
    /// Whether nothing behind it shows, anywhere.
    pub fn is_opaque(&self) -> bool {
        self.shape.leading() < 0.0 && self.stops.iter().all(|stop| stop.color[3] >= 1.0)
    }

    /// Its paint, once its numbers are at the end of `GRAD`.
    pub fn store(&self, numbers: &mut Vec<f32>) -> PaintRecord {
        let data_first = count(numbers.len());
        numbers.extend(self.shape.numbers());
        for stop in &self.stops {
            numbers.push(stop.offset);
            numbers.extend(stop.color);
        }
        let opaque = if self.is_opaque() { FLAG_OPAQUE } else { 0 };
        PaintRecord {
            kind: self.shape.kind(),
            flags: self.spread as u32 | opaque,
            data_first,
            data_count: count(numbers.len()) - data_first,
            color: [0.0; 4],
        }
    }

    /// The gradient of a paint; `None` for a solid one, and where its numbers do not exist or are
    /// not as many as a gradient has.
    pub fn of(paint: &PaintRecord, numbers: &[f32]) -> Option<Self> {
        let own = numbers.get(paint.data_first as usize..)?;
        let own = own.get(..paint.data_count as usize)?;
        let (shape, stops) = match paint.kind {
            KIND_LINEAR => {
                let (&t_from_uv, stops) = own.split_first_chunk()?;
                (GradientShape::Linear { t_from_uv }, stops)
            }
            KIND_RADIAL => {
                let (&circle_from_uv, rest) = own.split_first_chunk()?;
                let (&[distance, focal_radius], stops) = rest.split_first_chunk()?;
                let shape = GradientShape::Radial {
                    circle_from_uv,
                    distance,
                    focal_radius,
                };
                (shape, stops)
            }
            _ => return None,
        };
        let spread = match paint.flags & SPREAD_MASK {
            0 => Spread::Pad,
            1 => Spread::Reflect,
            2 => Spread::Repeat,
            _ => return None,
        };
        // Whatever follows the numbers of the shape must be whole stops.
        let (stops, rest) = stops.as_chunks::<STOP_NUMBERS>();
        let some = (1..=MAX_GRADIENT_STOPS as usize).contains(&stops.len());
        (some && rest.is_empty()).then(|| Self {
            shape,
            spread,
            stops: stops.iter().map(stop).collect(),
        })
    }

    /// Bits that a gradient's flags may have.
    pub(crate) fn flags_have_meaning(flags: u32) -> bool {
        flags & !(SPREAD_MASK | FLAG_OPAQUE) == 0 && flags & SPREAD_MASK != SPREAD_MASK
    }
}

/// The greatest t of the circles through `p` whose radius is not negative: the roots of
/// `|p - t (distance, 0)|^2 = (focal + t growth)^2`.
fn circle([x, y]: [f64; 2], distance: f64, focal: f64) -> Option<f64> {
    let growth = 1.0 - focal;
    let (a, b, c) = (
        distance * distance - growth * growth,
        -2.0 * (x * distance + focal * growth),
        x * x + y * y - focal * focal,
    );
    let roots = if a.abs() < 1e-12 {
        [-c / b, -c / b]
    } else {
        let root = (b * b - 4.0 * a * c).sqrt();
        [(-b + root) / (2.0 * a), (-b - root) / (2.0 * a)]
    };
    let sound = roots.into_iter().filter(|t| focal + t * growth >= 0.0);
    sound.max_by(f64::total_cmp)
}

fn stop(&[offset, r, g, b, a]: &[f32; STOP_NUMBERS]) -> GradientStop {
    GradientStop {
        offset,
        color: [r, g, b, a],
    }
}

/// Numbers beyond 2^32 are more than any section holds; the validator finds them missing.
fn count(numbers: usize) -> u32 {
    u32::try_from(numbers).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::GradientShape;

    /// Squared distance of `p` from the centre of the circle of `t`, less its squared radius; `None`
    /// where the radius is negative.
    fn beyond(p: [f64; 2], [distance, focal]: [f64; 2], t: f64) -> Option<f64> {
        let radius = focal + t * (1.0 - focal);
        let from_centre = [p[0] - t * distance, p[1]];
        let squared = from_centre[0].powi(2) + from_centre[1].powi(2);
        (radius >= 0.0).then_some(squared - radius * radius)
    }

    #[test]
    fn t_is_that_of_the_last_circle_through_the_place() {
        let circles = [
            [0.0, 0.0],
            [0.5, 0.25],
            [1.5, 0.25],
            [0.75, 1.0],
            [0.5, 2.0],
        ];
        for [distance, focal_radius] in circles {
            let shape = GradientShape::Radial {
                circle_from_uv: [1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
                distance,
                focal_radius,
            };
            let lengths = [distance, focal_radius].map(f64::from);
            for i in 0..400 {
                let p = [i % 20, i / 20].map(|i| f64::from(i) * 0.31 - 3.0);
                let t = shape.t_at(p);
                if let Some(t) = t {
                    let on = beyond(p, lengths, t).expect("a radius");
                    assert!(on.abs() < 1e-9, "{lengths:?} {p:?} {t}: {on}");
                }
                // No circle behind it passes through the place, or none at all.
                let first = t.map_or(-50.0, |t| t + 1e-3);
                let behind = (0..10_000).map(|i| first + 0.01 * f64::from(i));
                let mut sides = behind.filter_map(|t| Some(beyond(p, lengths, t)? > 0.0));
                if let Some(side) = sides.next() {
                    assert!(sides.all(|other| other == side), "{lengths:?} {p:?} {t:?}");
                }
            }
        }
    }

    #[test]
    fn lengths_are_not_negative_and_numbers_finite() {
        let radial = |distance, focal_radius| GradientShape::Radial {
            circle_from_uv: [1.0; 6],
            distance,
            focal_radius,
        };
        let linear = |c| GradientShape::Linear {
            t_from_uv: [1.0, 2.0, c],
        };
        assert!(radial(0.0, -0.0).is_sound() && linear(-3.0).is_sound());
        for wrong in [
            radial(-0.5, 0.0),
            radial(0.0, f32::NAN),
            radial(f32::INFINITY, 0.0),
            linear(f32::NEG_INFINITY),
        ] {
            assert!(!wrong.is_sound(), "{wrong:?}");
        }
    }
}
