//! Where the picture is taken from.

use glam::Vec3;

use crate::RuntimeError;

/// A pinhole camera in world space (right-handed, y up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole.
    pub position: [f32; 3],
    /// A point in the middle of the picture.
    pub target: [f32; 3],
    /// What is up in the picture; must not point along the view.
    pub up: [f32; 3],
    /// Full vertical angle of view in radians, in (0, pi).
    pub fov_y_rad: f32,
}

impl Camera {
    /// A camera that sees a rectangle lying in the plane z = 0, `width` by `height` around
    /// `center`, as large as a film of width / height = `film_aspect` allows.
    pub fn facing_rect(center: [f32; 2], size: [f32; 2], film_aspect: f32) -> Self {
        let height = size[1].max(size[0] / film_aspect);
        // A narrow angle keeps rays nearly parallel, so that footprints are even over the plane.
        let fov_y_rad: f32 = 0.2;
        let distance = 0.5 * height / (0.5 * fov_y_rad).tan();
        let [x, y] = center;
        Self {
            position: [x, y, distance],
            target: [x, y, 0.0],
            up: [0.0, 1.0, 0.0],
            fov_y_rad,
        }
    }

    /// The camera's axes: right, up, forward, unit length.
    pub(crate) fn axes(&self) -> Result<[Vec3; 3], RuntimeError> {
        let [position, target, up] = [self.position, self.target, self.up].map(Vec3::from);
        let forward = (target - position).try_normalize();
        // No length when `up` points along the view or is zero.
        let right = forward.and_then(|f| f.cross(up).try_normalize());
        match (forward, right) {
            (Some(forward), Some(right))
                if position.is_finite()
                    && self.fov_y_rad > 0.0
                    && self.fov_y_rad < std::f32::consts::PI =>
            {
                // Not `up` itself, which need not be at a right angle to the view.
                Ok([right, right.cross(forward), forward])
            }
            _ => Err(RuntimeError::Parameter(format!(
                "camera has no direction or angle: {self:?}"
            ))),
        }
    }
}
