//! A scene as buffers on the device.

use glam::Vec3;
use wgpu::{Buffer, BufferUsages, Device, Queue};

use super::TraceOptions;
use super::queues::TextureQueues;
use super::records::{
    FrameRecord, LightRecord, MaterialRecord, NONE, SURFACE_DIFFUSE, SURFACE_GLOSSY,
};
use super::textures::PackedTextures;
use super::world::{World, index_u32};
use crate::RuntimeError;
use crate::device::{Uploaded, checked, filled_buffer};
use crate::scene::{Camera, MAX_LIGHTS, Material, RectLight, Scene, Surface};

/// GGX turns into a mirror below this, and f32 loses its peak.
const MIN_GGX_ALPHA: f32 = 0.001;

/// The scene on the device.
#[derive(Debug)]
pub(super) struct SceneBuffers {
    frame: Buffer,
    frame_record: FrameRecord,
    nodes: Buffer,
    triangles: Buffer,
    attributes: Buffer,
    materials: Buffer,
    textures: Uploaded,
    texture_features: u32,
    texture_places: Vec<[u32; 2]>,
    queues: TextureQueues,
    has_veils: bool,
    /// Numbers of triangles; what was uploaded is not kept.
    world: World,
}

impl SceneBuffers {
    pub(super) async fn upload(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        options: &TraceOptions,
    ) -> Result<Self, RuntimeError> {
        let mut world = World::new(scene)?;
        let packed = PackedTextures::new(&scene.textures)?;
        let queues = TextureQueues::new(&scene.textures, options.trust);
        let lookups: Vec<[u32; 2]> = (packed.places.iter().map(|[first, _]| *first))
            .zip(queues.of_texture.iter().copied())
            .map(<[u32; 2]>::from)
            .collect();
        let materials = material_records(scene, &lookups);
        let frame_record = frame_record(scene, size, options, world.first_level)?;
        checked(device, "scene", || {
            let filled =
                |label, bytes: &[u8], usage| filled_buffer(device, queue, label, bytes, usage);
            let storage = |label, bytes: &[u8]| filled(label, bytes, BufferUsages::STORAGE);
            let frame = bytemuck::bytes_of(&frame_record);
            Ok(Self {
                frame: filled("vtex frame", frame, BufferUsages::UNIFORM)?,
                frame_record,
                nodes: storage("vtex BVH nodes", bytemuck::cast_slice(&world.nodes))?,
                triangles: storage("vtex triangles", bytemuck::cast_slice(&world.triangles))?,
                attributes: storage("vtex attributes", bytemuck::cast_slice(&world.attributes))?,
                materials: storage("vtex materials", bytemuck::cast_slice(&materials))?,
                textures: Uploaded::new(device, queue, &packed.words, &packed.texels)?,
                texture_features: packed.features,
                texture_places: packed.places,
                queues,
                has_veils: (scene.instances.iter())
                    .any(|instance| scene.materials[instance.material].is_veil()),
                world: {
                    world.free_uploaded();
                    world
                },
            })
        })
        .await
    }

    /// In the order of `trace/bindings.wgsl`.
    pub(super) fn bindings<'a>(&'a self, pass: &'a Buffer) -> [&'a Buffer; 6] {
        [
            &self.frame,
            pass,
            &self.nodes,
            &self.triangles,
            &self.attributes,
            &self.materials,
        ]
    }

    pub(super) fn textures(&self) -> &Uploaded {
        &self.textures
    }

    /// Union of the textures' features: what the evaluator has to contain.
    pub(super) fn texture_features(&self) -> u32 {
        self.texture_features
    }

    /// First word of a texture and how many it has.
    pub(super) fn texture(&self, index: usize) -> Option<[u32; 2]> {
        self.texture_places.get(index).copied()
    }

    pub(super) fn queues(&self) -> &TextureQueues {
        &self.queues
    }

    /// Whether any surface may let rays through.
    pub(super) fn has_veils(&self) -> bool {
        self.has_veils
    }

    pub(super) fn world(&self) -> &World {
        &self.world
    }

    /// Bytes of triangles, hierarchies and instances on the device.
    pub(super) fn geometry_bytes(&self) -> u64 {
        self.nodes.size() + self.triangles.size() + self.attributes.size()
    }

    pub(super) fn set_camera(
        &mut self,
        queue: &Queue,
        camera: &Camera,
    ) -> Result<(), RuntimeError> {
        set_camera(&mut self.frame_record, camera)?;
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&self.frame_record));
        Ok(())
    }
}

/// The scene's materials, then one for each light.
/// `lookups`: of each texture its first word and its queue.
fn material_records(scene: &Scene, lookups: &[[u32; 2]]) -> Vec<MaterialRecord> {
    let surfaces = scene
        .materials
        .iter()
        .map(|material| material_record(material, lookups));
    let lights = (0..)
        .zip(&scene.lights)
        .map(|(index, light)| MaterialRecord {
            emission: color(light.radiance),
            light: index,
            ..material_record(&Material::default(), lookups)
        });
    surfaces.chain(lights).collect()
}

fn material_record(material: &Material, lookups: &[[u32; 2]]) -> MaterialRecord {
    let lookup = material.texture.map(|index| lookups[index]);
    let [texture_word, texture_queue] = lookup.unwrap_or([NONE, 0]);
    let (metallic, roughness) = material.surface.parameters();
    MaterialRecord {
        base_color: color(material.base_color),
        emission: color(material.emission),
        backing: match material.backing {
            Some([r, g, b]) => [r, g, b, 1.0],
            None => [0.0; 4],
        },
        metallic,
        ggx_alpha: (roughness * roughness).max(MIN_GGX_ALPHA),
        surface: match material.surface {
            Surface::Diffuse => SURFACE_DIFFUSE,
            Surface::Glossy { .. } => SURFACE_GLOSSY,
        },
        texture_word,
        light: NONE,
        texture_queue,
        reserved1: 0,
        reserved2: 0,
    }
}

fn frame_record(
    scene: &Scene,
    film_size: [u32; 2],
    options: &TraceOptions,
    first_level: u32,
) -> Result<FrameRecord, RuntimeError> {
    let mut lights = [bytemuck::Zeroable::zeroed(); MAX_LIGHTS];
    for (record, light) in lights.iter_mut().zip(&scene.lights) {
        *record = light_record(light);
    }
    let mut frame = FrameRecord {
        camera_position: [0.0; 4],
        camera_right: [0.0; 4],
        camera_up: [0.0; 4],
        camera_forward: [0.0; 4],
        sky_zenith: color(scene.sky.zenith),
        sky_horizon: color(scene.sky.horizon),
        sky_ground: color(scene.sky.ground),
        film_width: film_size[0],
        film_height: film_size[1],
        light_count: index_u32(scene.lights.len()),
        triangle_count: first_level,
        seed: options.seed,
        max_bounces: options.max_bounces,
        light_sampling: options.light_sampling as u32,
        transparent_background: options.background as u32,
        camera_slope: 0.0,
        footprint_scale: options.footprint_scale,
        // The shader compares with it; infinity is not a WGSL value.
        indirect_clamp: options.indirect_clamp.min(f32::MAX),
        reserved: 0.0,
        lights,
    };
    set_camera(&mut frame, &scene.camera)?;
    Ok(frame)
}

fn light_vectors(light: &RectLight) -> [Vec3; 3] {
    [light.corner, light.edge_u, light.edge_v].map(Vec3::from)
}

fn light_record(light: &RectLight) -> LightRecord {
    let [corner, edge_u, edge_v] = light_vectors(light);
    let cross = edge_u.cross(edge_v);
    LightRecord {
        corner: vector(corner),
        edge_u: vector(edge_u),
        edge_v: vector(edge_v),
        normal_area: cross.normalize_or_zero().extend(cross.length()).to_array(),
        radiance: color(light.radiance),
    }
}

fn set_camera(frame: &mut FrameRecord, camera: &Camera) -> Result<(), RuntimeError> {
    let [right, up, forward] = camera.axes()?;
    let [width, height] = [frame.film_width, frame.film_height].map(|side| side as f32);
    let half_height = (0.5 * camera.fov_y_rad).tan();
    frame.camera_position = vector(camera.position.into());
    frame.camera_right = vector(right * (half_height * width / height));
    frame.camera_up = vector(up * half_height);
    frame.camera_forward = vector(forward);
    // A pixel is 2 half_height / height wide at distance 1; the cone grows by 2 t slope.
    frame.camera_slope = frame.footprint_scale * half_height / height;
    Ok(())
}

fn vector(v: Vec3) -> [f32; 4] {
    v.extend(0.0).to_array()
}

fn color([r, g, b]: [f32; 3]) -> [f32; 4] {
    [r, g, b, 0.0]
}
