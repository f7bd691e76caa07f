//! Scenes that the command line, the benchmarks and the tests trace.

use glam::{Affine3A, Quat, Vec3};
use vtex_format::{AddressMode, VtexFile};
use vtex_runtime::scene::canvas_aspect;
use vtex_runtime::{Camera, Instance, LoadOptions, Material, Mesh, RectLight, Scene, Sky, Surface};

/// A sign board, a glazed ball, a mug and a panel on the floor, in front of a wall, under a ceiling
/// light and a pale sky. The camera is framed for a 3:2 film.
///
/// Each object shows the next of `files`, from the first again when they run out. Without files all
/// objects are plain. The floor panel shows its texture at grazing angles.
pub fn showroom(files: Vec<VtexFile>) -> Scene {
    let mut room = Room::new(files);
    room.walls();
    room.sign();
    room.ball();
    room.mug();
    room.floor_panel();
    room.scene
}

/// Colour under the drawings and of objects without one.
const PAPER: [f32; 3] = [0.82, 0.81, 0.78];

struct Room {
    scene: Scene,
    files: Vec<VtexFile>,
    taken: usize,
}

impl Room {
    fn new(files: Vec<VtexFile>) -> Self {
        Self {
            scene: Scene {
                meshes: Vec::new(),
                instances: Vec::new(),
                materials: Vec::new(),
                textures: Vec::new(),
                environment: None,
                punctual: Vec::new(),
                sky: Sky {
                    zenith: [0.16, 0.20, 0.26],
                    horizon: [0.55, 0.57, 0.6],
                    ground: [0.12, 0.12, 0.11],
                },
                lights: vec![RectLight {
                    corner: [-2.2, 4.0, -0.2],
                    edge_u: [2.4, 0.0, 0.0],
                    edge_v: [0.0, -0.8, 1.6],
                    radiance: [10.5, 10.1, 9.4],
                }],
                camera: Camera {
                    position: [0.25, 1.45, 4.9],
                    target: [0.0, 0.42, 0.0],
                    up: [0.0, 1.0, 0.0],
                    fov_y_rad: 0.55,
                },
            },
            files,
            taken: 0,
        }
    }

    /// The floor, and a wall far enough behind the objects to cast no shadow on them.
    fn walls(&mut self) {
        let floor = Material {
            base_color: [0.32, 0.31, 0.30],
            surface: Surface::Glossy {
                metallic: 0.0,
                roughness: 0.35,
            },
            ..Material::default()
        };
        let wall = Material {
            base_color: [0.30, 0.36, 0.42],
            ..Material::default()
        };
        let lying = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        self.add(Mesh::plane(40.0, 40.0), floor, lying);
        let back = Affine3A::from_translation(Vec3::new(0.0, 3.0, -3.0));
        self.add(Mesh::plane(40.0, 6.0), wall, back);
    }

    /// A surface that shows `texture` over paper, or paper alone.
    fn printed(texture: Option<usize>, surface: Surface) -> Material {
        Material {
            base_color: if texture.is_some() { [1.0; 3] } else { PAPER },
            texture,
            backing: Some(PAPER),
            surface,
            ..Material::default()
        }
    }

    /// A board on the left whose front shows the whole drawing.
    fn sign(&mut self) {
        let (texture, aspect) = self.take(None);
        let [width, height] = fitted(aspect, [1.25, 1.15]);
        let turn = Quat::from_rotation_y(0.30);
        let center = Vec3::new(-1.15, 0.5 * height + 0.06, -0.25);
        let place =
            |offset: Vec3| Affine3A::from_rotation_translation(turn, center + turn * offset);
        let frame = Material {
            base_color: [0.10, 0.11, 0.13],
            surface: Surface::Glossy {
                metallic: 1.0,
                roughness: 0.3,
            },
            ..Material::default()
        };
        let size = [width + 0.06, height + 0.06, 0.05];
        self.add(Mesh::cuboid(size), frame, place(Vec3::ZERO));
        let face = Self::printed(texture, Surface::Diffuse);
        self.add(Mesh::plane(width, height), face, place(Vec3::Z * 0.026));
    }

    /// A glazed ball in the middle, the drawing once on each half.
    fn ball(&mut self) {
        let around = [AddressMode::Repeat, AddressMode::Clamp];
        let (texture, _) = self.take(Some(around));
        let glazed = Self::printed(
            texture,
            Surface::Glossy {
                metallic: 0.0,
                roughness: 0.12,
            },
        );
        let place = Affine3A::from_rotation_translation(
            Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
            Vec3::new(0.12, 0.52, -0.35),
        );
        self.add(Mesh::sphere(0.52, 128, 2.0), glazed, place);
    }

    /// A mug on the right: the drawing goes round it as often as its proportions allow.
    fn mug(&mut self) {
        let around = [AddressMode::Repeat, AddressMode::Clamp];
        let (texture, aspect) = self.take(Some(around));
        let (radius, height) = (0.33, 0.78);
        let copies = (std::f32::consts::TAU * radius / (height * aspect))
            .round()
            .max(1.0);
        let surface = Surface::Glossy {
            metallic: 0.0,
            roughness: 0.25,
        };
        let printed = Self::printed(texture, surface);
        let plain = Material {
            base_color: PAPER,
            surface,
            ..Material::default()
        };
        let center = Vec3::new(1.15, 0.5 * height, 0.1);
        // u = 0.5 faces the camera. With an even number of copies a seam lies there, so the mug is
        // turned by half a copy.
        let to_camera = Vec3::from(self.scene.camera.position) - center;
        let half_copy = if copies % 2.0 == 0.0 {
            std::f32::consts::PI / copies
        } else {
            0.0
        };
        let turn = to_camera.x.atan2(to_camera.z) + half_copy;
        let upright = Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), center);
        self.add(Mesh::cylinder(radius, height, 96, copies), printed, upright);
        let inside = Affine3A::from_translation(center);
        self.add(
            Mesh::cylinder(0.94 * radius, height, 96, 1.0),
            plain,
            inside,
        );
        let bottom = Affine3A::from_translation(Vec3::new(center.x, 0.03, center.z));
        self.add(Mesh::disc(radius, 96), plain, bottom);
    }

    /// A panel lying in the foreground, seen at a grazing angle.
    fn floor_panel(&mut self) {
        let (texture, aspect) = self.take(None);
        let [width, depth] = fitted(aspect, [1.8, 1.2]);
        let panel = Self::printed(texture, Surface::Diffuse);
        let place = Affine3A::from_rotation_translation(
            Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
            Vec3::new(0.0, 0.004, 1.3),
        );
        self.add(Mesh::plane(width, depth), panel, place);
    }

    /// The next texture and its proportions. Each object gets a copy of its own, since the address
    /// mode is set when a texture is loaded.
    fn take(&mut self, address: Option<[AddressMode; 2]>) -> (Option<usize>, f32) {
        if self.files.is_empty() {
            return (None, 1.0);
        }
        let file = self.files[self.taken % self.files.len()].clone();
        self.taken += 1;
        let aspect = canvas_aspect(&file);
        let mut options = LoadOptions::default();
        options.pack.address = address.or(options.pack.address);
        self.scene.textures.push((file, options));
        (Some(self.scene.textures.len() - 1), aspect)
    }

    fn add(&mut self, mesh: Mesh, material: Material, world_from_object: Affine3A) {
        self.scene.instances.push(Instance {
            mesh: self.scene.meshes.len(),
            material: self.scene.materials.len(),
            world_from_object: world_from_object.to_cols_array_2d(),
        });
        self.scene.meshes.push(mesh);
        self.scene.materials.push(material);
    }
}

/// The largest size of these proportions that fits `limit`.
fn fitted(aspect: f32, limit: [f32; 2]) -> [f32; 2] {
    let width = limit[0].min(limit[1] * aspect);
    [width, width / aspect]
}
