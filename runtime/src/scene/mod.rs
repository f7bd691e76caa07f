//! What is in the picture.
//!
//! Points, vectors and matrices are plain arrays, so that a program may use any version of any
//! linear algebra crate.

mod camera;
mod light;
mod material;
mod mesh;
mod plane;

use vtex_format::VtexFile;

pub use camera::Camera;
pub use light::{Environment, PunctualKind, PunctualLight, RectLight, Sky};
pub use material::{Coat, Dielectric, Glass, Material, Surface};
pub use mesh::{MAX_TRIANGLES, Mesh};
pub use plane::{canvas_aspect, plane, plane_camera};

use crate::{LoadOptions, RuntimeError};

/// Meshes, how they look, what lights them and who looks at them. World space is right-handed,
/// y up, in whatever unit the caller likes; radiance is linear, Rec. 709 primaries.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Meshes in object space.
    pub meshes: Vec<Mesh>,
    /// Meshes placed in the world.
    pub instances: Vec<Instance>,
    /// Materials that instances name.
    pub materials: Vec<Material>,
    /// Vector textures that materials name, each with how it is looked up.
    pub textures: Vec<(VtexFile, LoadOptions)>,
    /// Light from everywhere else, where there is no `environment`.
    pub sky: Sky,
    /// Light from everywhere else as a panorama has it.
    pub environment: Option<Environment>,
    /// Area lights.
    pub lights: Vec<RectLight>,
    /// Lights without size.
    pub punctual: Vec<PunctualLight>,
    /// The viewer.
    pub camera: Camera,
}

/// One mesh placed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Object space to world space, column by column: where the unit vectors along x, y and z go,
    /// then where the origin goes. As `glam::Affine3A::to_cols_array_2d` gives it; a column-major
    /// 4 x 4 matrix such as glTF's without its last row.
    pub world_from_object: [[f32; 3]; 4],
}

impl Instance {
    /// A [`Instance::world_from_object`] that leaves a mesh where it is.
    pub const IDENTITY: [[f32; 3]; 4] = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0],
    ];
}

impl Scene {
    /// Checks indices and numbers, so that what follows may rely on them.
    pub(crate) fn check(&self) -> Result<(), RuntimeError> {
        self.meshes.iter().try_for_each(Mesh::check)?;
        let instances_ok = self.instances.iter().all(|instance| {
            instance.mesh < self.meshes.len()
                && instance.material < self.materials.len()
                && finite(instance.world_from_object.as_flattened())
        });
        require(
            instances_ok,
            "instance: unknown mesh or material, or a matrix that is not finite",
        )?;
        let textures = self.textures.len();
        let materials_ok = self
            .materials
            .iter()
            .all(|material| material.is_valid(textures));
        require(
            materials_ok,
            "material: a number out of its range or an unknown texture",
        )?;
        require(
            self.lights.iter().all(RectLight::is_valid),
            "light: no area or bad radiance",
        )?;
        require(
            self.punctual.iter().all(PunctualLight::is_valid),
            "punctual light: no place, no direction, bad angles or bad intensity",
        )?;
        require(self.sky.is_valid(), "sky: bad radiance")?;
        require(
            self.environment.iter().all(Environment::is_valid),
            "environment: bad radiance, or not as many texels as it has columns and rows",
        )
    }
}

fn finite(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

fn unit(value: f32) -> bool {
    (0.0..=1.0).contains(&value)
}

fn radiance(value: f32) -> bool {
    value.is_finite() && value >= 0.0
}

fn require(holds: bool, what: &str) -> Result<(), RuntimeError> {
    if holds {
        Ok(())
    } else {
        Err(RuntimeError::Parameter(format!("scene: {what}")))
    }
}
