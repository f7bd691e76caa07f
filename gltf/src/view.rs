//! A view of a scene that names none.

use glam::{Affine3A, Vec3, Vec3A};
use vtex_runtime::{Camera, Scene};

/// Angle of view.
const FOV_Y_RAD: f32 = 0.6;
/// Where the camera stands as seen from the middle: in front, a little to the right and above.
const FROM: Vec3 = Vec3::new(0.45, 0.35, 1.0);
/// Positions beyond this are not traced either.
const MOST_COORDINATE: f32 = 1.0e12;

/// A camera that sees all of `scene` on a film of width / height = `film_aspect`.
pub fn view_of(scene: &Scene, film_aspect: f32) -> Camera {
    let (mut min, mut max) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
    let within = |p: Vec3A| p.abs().cmple(Vec3A::splat(MOST_COORDINATE)).all();
    let boxes: Vec<(Vec3A, Vec3A)> = (scene.meshes.iter())
        .map(|mesh| {
            let corners = mesh.triangles.iter().flatten();
            let points = corners.filter_map(|&i| mesh.positions.get(i as usize));
            let points = points.map(|&p| Vec3A::from(p)).filter(|&p| within(p));
            points.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), p| {
                (low.min(p), high.max(p))
            })
        })
        .collect();
    for instance in &scene.instances {
        let to_world = Affine3A::from_cols_array_2d(&instance.world_from_object);
        let Some((low, high)) = boxes.get(instance.mesh) else {
            continue;
        };
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low } else { high }[axis];
            let point = to_world.transform_point3a(Vec3A::new(pick(0), pick(1), pick(2)));
            if within(point) {
                (min, max) = (min.min(point), max.max(point));
            }
        }
    }
    if !(min.is_finite() && max.is_finite()) {
        (min, max) = (Vec3A::NEG_ONE, Vec3A::ONE);
    }
    let middle = Vec3::from(0.5 * (min + max));
    let radius = (0.5 * (max - min)).length().max(1.0e-6);
    // The sphere about the box fits the narrower side of the film.
    let half = (0.5 * FOV_Y_RAD).tan() * film_aspect.min(1.0);
    let distance = radius / half.atan().sin();
    Camera {
        position: (middle + FROM.normalize() * distance).to_array(),
        target: middle.to_array(),
        up: [0.0, 1.0, 0.0],
        fov_y_rad: FOV_Y_RAD,
    }
}
