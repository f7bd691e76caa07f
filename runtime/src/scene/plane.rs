//! A texture on a plane, seen straight on.

use vtex_format::VtexFile;

use crate::{Camera, Instance, LoadOptions, Material, Mesh, Scene, Sky};

/// Shows `file` upright on a plane 1 unit high, seen straight on by [`plane_camera`], for a film
/// with the proportions of the canvas. A diffuse plane under a uniform white sky reflects exactly
/// its own colour, so the picture is the drawing on white.
pub fn plane(file: VtexFile, options: LoadOptions) -> Scene {
    let aspect = canvas_aspect(&file);
    Scene {
        meshes: vec![Mesh::plane(aspect, 1.0)],
        instances: vec![Instance {
            mesh: 0,
            material: 0,
            world_from_object: Instance::IDENTITY,
        }],
        materials: vec![Material {
            texture: Some(0),
            ..Material::default()
        }],
        camera: plane_camera(&file, [0.0, 0.0, 1.0, 1.0], aspect),
        textures: vec![(file, options)],
        sky: Sky::uniform(1.0),
        environment: None,
        lights: Vec::new(),
        punctual: Vec::new(),
    }
}

/// A camera for [`plane`] that shows the part `view_uv` (left, top, right, bottom) of the canvas
/// of `file`, as large as a film of width / height = `film_aspect` allows.
pub fn plane_camera(file: &VtexFile, view_uv: [f32; 4], film_aspect: f32) -> Camera {
    let aspect = canvas_aspect(file);
    let [left, top, right, bottom] = view_uv;
    // v grows downwards, y upwards: the two halves have opposite signs.
    let center = [
        (0.5 * (left + right) - 0.5) * aspect,
        0.5 - 0.5 * (top + bottom),
    ];
    let size = [(right - left) * aspect, bottom - top];
    Camera::facing_rect(center, size, film_aspect)
}

/// Width over height of the canvas of `file`; 1 where the canvas has no area.
pub fn canvas_aspect(file: &VtexFile) -> f32 {
    let [width, height] = file.meta.canvas_size;
    let aspect = width / height;
    if aspect.is_finite() && aspect > 0.0 {
        aspect
    } else {
        1.0
    }
}
