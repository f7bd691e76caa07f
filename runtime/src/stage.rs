//! Scenes ready to render: a texture on a plane, and a showroom of textured objects.

use glam::{Affine3A, Quat, Vec3};
use vtex_format::{AddressMode, VtexFile};

use crate::{Camera, Instance, LoadOptions, Material, Mesh, RectLight, Scene, Sky, Surface};

/// Shows `file` upright on a plane as high as 1 unit, seen straight on by [`plane_camera`] for a
/// film of the canvas' own proportions. A diffuse plane under a uniform white sky reflects just
/// its colour, so the picture is the drawing on white, exactly.
pub fn plane(file: VtexFile, options: LoadOptions) -> Scene {
    let aspect = aspect(&file);
    Scene {
        meshes: vec![Mesh::plane(aspect, 1.0)],
        instances: vec![Instance {
            mesh: 0,
            material: 0,
            world_from_object: Affine3A::IDENTITY,
        }],
        materials: vec![Material {
            texture: Some(0),
            ..Material::default()
        }],
        camera: plane_camera(&file, [0.0, 0.0, 1.0, 1.0], aspect),
        textures: vec![(file, options)],
        sky: Sky::uniform(1.0),
        lights: Vec::new(),
    }
}

/// A camera for [`plane`] that shows the part `view_uv` (left, top, right, bottom) of the canvas
/// of `file`, as large as a film of width / height = `film_aspect` allows.
pub fn plane_camera(file: &VtexFile, view_uv: [f32; 4], film_aspect: f32) -> Camera {
    let aspect = aspect(file);
    let [left, top, right, bottom] = view_uv;
    let center = [
        (0.5 * (left + right) - 0.5) * aspect,
        0.5 - 0.5 * (top + bottom),
    ];
    let size = [(right - left) * aspect, bottom - top];
    Camera::facing_rect(center, size, film_aspect)
}

/// Width over height of the canvas.
fn aspect(file: &VtexFile) -> f32 {
    let [width, height] = file.meta.canvas_size;
    let aspect = width / height;
    if aspect.is_finite() && aspect > 0.0 {
        aspect
    } else {
        1.0
    }
}

/// A sign board, a glazed ball, a mug, and floor and wall panels, lit by a panel overhead and a
/// pale sky, for a 3:2 film. Each object takes the next of `files` and starts over when they run
/// out; without any, all are plain. The floor panel shows its texture at grazing angles.
pub fn showroom(files: Vec<VtexFile>) -> Scene {
    let mut room = Room::new(files);
    room.ground();
    room.sign();
    room.ball();
    room.mug();
    room.floor_panel();
    room.scene
}

/// Colour of everything that is not drawn.
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
                sky: Sky {
                    zenith: [0.35, 0.45, 0.60],
                    horizon: [0.75, 0.78, 0.80],
                    ground: [0.25, 0.24, 0.22],
                },
                lights: vec![RectLight {
                    corner: Vec3::new(-2.2, 4.0, -0.2),
                    edge_u: Vec3::new(2.4, 0.0, 0.0),
                    edge_v: Vec3::new(0.0, -0.8, 1.6),
                    radiance: [9.0, 8.6, 8.0],
                }],
                camera: Camera {
                    position: Vec3::new(0.3, 1.55, 4.6),
                    target: Vec3::new(0.0, 0.62, 0.0),
                    up: Vec3::Y,
                    fov_y_rad: 0.55,
                },
            },
            files,
            taken: 0,
        }
    }

    fn ground(&mut self) {
        let material = Material {
            base_color: [0.46, 0.45, 0.44],
            surface: Surface::Glossy {
                metallic: 0.0,
                roughness: 0.35,
            },
            ..Material::default()
        };
        let lying = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        self.add(Mesh::plane(40.0, 40.0), material, lying);
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
        let size = Vec3::new(width + 0.06, height + 0.06, 0.05);
        self.add(Mesh::cuboid(size), frame, place(Vec3::ZERO));
        let face = Material {
            texture,
            backing: Some(PAPER),
            ..Material::default()
        };
        self.add(Mesh::plane(width, height), face, place(Vec3::Z * 0.026));
    }

    /// A glazed ball in the middle, the drawing once on each half.
    fn ball(&mut self) {
        let around = [AddressMode::Repeat, AddressMode::Clamp];
        let (texture, _) = self.take(Some(around));
        let glazed = Material {
            texture,
            backing: Some(PAPER),
            surface: Surface::Glossy {
                metallic: 0.0,
                roughness: 0.12,
            },
            ..Material::default()
        };
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
        let printed = Material {
            texture,
            backing: Some(PAPER),
            surface,
            ..Material::default()
        };
        let plain = Material {
            base_color: PAPER,
            surface,
            ..Material::default()
        };
        let center = Vec3::new(1.15, 0.5 * height, 0.1);
        // A copy's middle faces the camera.
        let turn = std::f32::consts::PI / copies;
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
        let [width, depth] = fitted(aspect, [1.5, 1.3]);
        let panel = Material {
            texture,
            backing: Some(PAPER),
            ..Material::default()
        };
        let place = Affine3A::from_rotation_translation(
            Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2),
            Vec3::new(0.0, 0.004, 1.35),
        );
        self.add(Mesh::plane(width, depth), panel, place);
    }

    /// The next texture and its proportions. Each object has a copy of its own, since address
    /// modes are part of a loaded texture.
    fn take(&mut self, address: Option<[AddressMode; 2]>) -> (Option<usize>, f32) {
        if self.files.is_empty() {
            return (None, 1.0);
        }
        let file = self.files[self.taken % self.files.len()].clone();
        self.taken += 1;
        let aspect = aspect(&file);
        let mut options = LoadOptions::default();
        options.pack.address = address.or(options.pack.address);
        self.scene.textures.push((file, options));
        (Some(self.scene.textures.len() - 1), aspect)
    }

    fn add(&mut self, mesh: Mesh, material: Material, world_from_object: Affine3A) {
        self.scene.instances.push(Instance {
            mesh: self.scene.meshes.len(),
            material: self.scene.materials.len(),
            world_from_object,
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
