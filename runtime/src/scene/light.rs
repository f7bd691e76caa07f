//! What lights a scene.

use glam::Vec3;

use super::{finite, radiance};

/// Radiance by direction: `horizon` at y = 0 blends to `zenith` above and to `ground` below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Straight up.
    pub zenith: [f32; 3],
    /// Level.
    pub horizon: [f32; 3],
    /// Straight down.
    pub ground: [f32; 3],
}

/// A rectangle that shines from its front, the side `edge_u x edge_v` points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RectLight {
    /// One corner, world space.
    pub corner: [f32; 3],
    /// From the corner along one side.
    pub edge_u: [f32; 3],
    /// From the corner along the other side.
    pub edge_v: [f32; 3],
    /// Linear radiance.
    pub radiance: [f32; 3],
}

/// A light without size, in world space and in the units of `KHR_lights_punctual`. Mirrors do not show
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunctualLight {
    /// What it is.
    pub kind: PunctualKind,
    /// Where it stands; not read of directional ones.
    pub position: [f32; 3],
    /// Where it shines to; not read of points.
    pub direction: [f32; 3],
    /// Linear: radiant intensity, so that a surface that faces it at distance 1 gets as much irradiance.
    /// Of directional ones that irradiance itself.
    pub intensity: [f32; 3],
    /// Beyond which it does not shine, reached smoothly.
    pub range: Option<f32>,
}

/// Kinds of [`PunctualLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PunctualKind {
    /// From infinitely far.
    Directional,
    /// To all sides.
    Point,
    /// Into a cone.
    Spot {
        /// Half angle within which it is as bright as in the middle, radians.
        inner_rad: f32,
        /// Half angle beyond which it is dark, radians, at most half of pi.
        outer_rad: f32,
    },
}

/// A panorama that lights the scene from infinitely far away and is seen behind it: equirectangular, as
/// usual for HDR files, linear, Rec. 709 primaries.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Columns and rows.
    pub size: [u32; 2],
    /// Radiance row by row from the top, which is +y. The middle column is -z, and those to its right turn
    /// to +x.
    pub texels: Vec<[f32; 3]>,
    /// By how much it is turned about y, radians, clockwise seen from above.
    pub turn_rad: f32,
}

impl Sky {
    /// The same radiance from everywhere.
    pub fn uniform(radiance: f32) -> Self {
        Self {
            zenith: [radiance; 3],
            horizon: [radiance; 3],
            ground: [radiance; 3],
        }
    }

    pub(super) fn is_valid(&self) -> bool {
        let all = [self.zenith, self.horizon, self.ground];
        all.iter().flatten().all(|&c| radiance(c))
    }
}

impl RectLight {
    pub(super) fn is_valid(&self) -> bool {
        // Not finite when an edge is not, or when the product overflows. The shader divides by it.
        let area = Vec3::from(self.edge_u).cross(self.edge_v.into()).length();
        finite(&self.corner)
            && area.is_finite()
            && area > 0.0
            && self.radiance.iter().all(|&c| radiance(c))
    }
}

impl PunctualLight {
    pub(super) fn is_valid(&self) -> bool {
        let half_turn = std::f32::consts::FRAC_PI_2 + 1.0e-3;
        let (place, aim) = match self.kind {
            PunctualKind::Directional => (true, true),
            PunctualKind::Point => (finite(&self.position), false),
            PunctualKind::Spot {
                inner_rad,
                outer_rad,
            } => {
                let in_order = inner_rad >= 0.0 && inner_rad <= outer_rad && outer_rad <= half_turn;
                (finite(&self.position) && in_order, true)
            }
        };
        let direction = Vec3::from(self.direction).try_normalize();
        place
            && (!aim || direction.is_some())
            && self.intensity.iter().all(|&c| radiance(c))
            // False for NaN.
            && self.range.is_none_or(|range| range > 0.0)
    }
}

impl Environment {
    /// A panorama of a picture whose numbers may be anything: what is negative or no number counts as
    /// dark, and what is infinite as the largest number of half floats.
    pub fn new(size: [u32; 2], texels: Vec<[f32; 3]>) -> Self {
        const MOST: f32 = 65_504.0;
        let mend = |value: f32| match value {
            value if value.is_nan() => 0.0,
            value if value.is_infinite() && value > 0.0 => MOST,
            value => value.max(0.0),
        };
        Self {
            size,
            texels: (texels.into_iter()).map(|texel| texel.map(mend)).collect(),
            turn_rad: 0.0,
        }
    }

    pub(super) fn is_valid(&self) -> bool {
        let [width, height] = self.size.map(|side| side as usize);
        width.checked_mul(height) == Some(self.texels.len())
            && !self.texels.is_empty()
            && self.turn_rad.is_finite()
            && self.texels.iter().flatten().all(|&c| radiance(c))
    }
}
