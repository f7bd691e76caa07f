//! Gradients: colours that depend on the place.

use super::paint::{PAINT_LINEAR, PAINT_RADIAL, PaintRecord};

/// Most stops of a gradient: bounds the search for a lookup's two. A paint with more is malformed.
pub const MAX_GRADIENT_STOPS: u32 = 1 << 15;

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
            kind: match self.shape {
                GradientShape::Linear { .. } => PAINT_LINEAR,
                GradientShape::Radial { .. } => PAINT_RADIAL,
            },
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
            PAINT_LINEAR => {
                let (&t_from_uv, stops) = own.split_first_chunk()?;
                (GradientShape::Linear { t_from_uv }, stops)
            }
            PAINT_RADIAL => {
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
