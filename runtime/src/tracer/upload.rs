//! A scene as buffers on the device.

use std::collections::BTreeMap;

use glam::Vec3;
use vtex_shaders::{LayerKinds, LightKinds, LinkContext};
use wgpu::{BindingResource, Buffer, BufferUsages, Device, Queue};

use super::TraceOptions;
use super::albedo;
use super::lights::{LIGHT_GROUPS, Lights, PanoramaTexture};
use super::queues::TextureQueues;
use super::records::{
    FrameRecord, MaterialRecord, NONE, SURFACE_DIFFUSE, SURFACE_GLOSSY, SURFACE_UNLIT,
};
use super::textures::PackedTextures;
use super::world::{Cutout, World, index_u32};
use crate::device::{Uploaded, checked, filled_buffer};
use crate::scene::{Camera, Material, Scene, Surface};
use crate::{RuntimeError, TexelFormat};

/// GGX turns into a mirror below this, and f32 loses its peak.
pub(super) const MIN_GGX_ALPHA: f32 = 0.001;

/// The scene on the device.
#[derive(Debug)]
pub(super) struct SceneBuffers {
    frame: Buffer,
    frame_record: FrameRecord,
    nodes: Buffer,
    triangles: Buffer,
    attributes: Buffer,
    materials: Buffer,
    panorama: PanoramaTexture,
    light_kinds: LightKinds,
    layer_kinds: LayerKinds,
    notices: Vec<String>,
    textures: Uploaded,
    texture_features: u32,
    texture_places: Vec<[u32; 2]>,
    queues: TextureQueues,
    has_veils: bool,
    has_cutouts: bool,
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
        let mut lights = Lights::new(scene);
        let mut materials = material_records(scene, &lookups, &lights.densities);
        let mut frame_record = frame_record(scene, size, options, &world, &lights)?;
        world.nodes.append(&mut lights.groups);
        world.nodes.extend(albedo::table());
        frame_record.colors_first = index_u32(world.nodes.len());
        let has_colors = !world.colors.is_empty();
        world.nodes.append(&mut world.colors);
        let has_cutouts = add_cutouts(scene, &mut world, &mut materials);
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
                panorama: match &lights.panorama {
                    Some(shown) => PanoramaTexture::new(device, queue, shown.size, &shown.texels),
                    None => PanoramaTexture::new(device, queue, [1; 2], &[0]),
                },
                light_kinds: lights.kinds,
                layer_kinds: LayerKinds {
                    coats: scene.materials.iter().any(|m| m.coat.is_some()),
                    glass: scene.materials.iter().any(|m| m.glass.is_some()),
                    colors: has_colors,
                },
                notices: lights.notices,
                textures: Uploaded::new(
                    device,
                    queue,
                    &packed.words,
                    &packed.texels,
                    TexelFormat::Rgba8,
                )?,
                texture_features: packed.features,
                texture_places: packed.places,
                queues,
                has_cutouts,
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
    pub(super) fn bindings<'a>(&'a self, pass: &'a Buffer) -> [BindingResource<'a>; 8] {
        let [texture, sampler] = self.panorama.resources();
        [
            self.frame.as_entire_binding(),
            pass.as_entire_binding(),
            self.nodes.as_entire_binding(),
            self.triangles.as_entire_binding(),
            self.attributes.as_entire_binding(),
            self.materials.as_entire_binding(),
            texture,
            sampler,
        ]
    }

    /// `context` with the code that this scene needs: any text that imports `trace/bvh` or `trace/light`
    /// is to be linked with it.
    pub(super) fn code(&self, context: LinkContext) -> LinkContext {
        let context = match self.has_cutouts {
            true => context,
            false => vtex_shaders::without_cutouts(context),
        };
        let context = vtex_shaders::with_lights(self.world.levels(context), self.light_kinds);
        vtex_shaders::with_layers(context, self.layer_kinds)
    }

    /// Whether traversal reads textures' cells.
    pub(super) fn has_cutouts(&self) -> bool {
        self.has_cutouts
    }

    /// What of the scene's light was left out.
    pub(super) fn notices(&self) -> &[String] {
        &self.notices
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

/// The scene's materials, then one for each area light.
/// `lookups`: of each texture its first word and its queue. `densities`: see [`Lights`].
fn material_records(scene: &Scene, lookups: &[[u32; 2]], densities: &[f32]) -> Vec<MaterialRecord> {
    let surfaces = (scene.materials.iter()).map(|material| material_record(material, lookups));
    let panels = scene.lights.iter().map(|light| MaterialRecord {
        emission: color(light.radiance),
        is_panel: 1,
        ..material_record(&Material::default(), lookups)
    });
    let records = surfaces.chain(panels).zip(densities);
    records
        .map(|(record, &light_density)| MaterialRecord {
            light_density,
            ..record
        })
        .collect()
}

/// Puts cutouts among the nodes and their places into the materials; whether there are any.
fn add_cutouts(scene: &Scene, world: &mut World, materials: &mut [MaterialRecord]) -> bool {
    let mut known: BTreeMap<usize, u32> = BTreeMap::new();
    for (material, record) in scene.materials.iter().zip(materials) {
        let Some(texture) = material.texture.filter(|_| material.is_veil()) else {
            continue;
        };
        record.cutout = *known.entry(texture).or_insert_with(|| {
            let (file, options) = &scene.textures[texture];
            Cutout::new(file, options).map_or(0, |cutout| {
                let place = index_u32(world.nodes.len());
                world.nodes.extend(cutout.groups());
                place
            })
        });
    }
    known.values().any(|&place| place != 0)
}

fn material_record(material: &Material, lookups: &[[u32; 2]]) -> MaterialRecord {
    let lookup = material.texture.map(|index| lookups[index]);
    let [texture_word, texture_queue] = lookup.unwrap_or([NONE, 0]);
    let (metallic, roughness) = material.surface.parameters();
    let alpha = |roughness: f32| (roughness * roughness).max(MIN_GGX_ALPHA);
    let [r, g, b] = material.dielectric.straight_on;
    let coat = material.coat.unwrap_or_default();
    let (transmission, glass) = match material.glass {
        Some(glass) => {
            let [x, y, z] = glass.absorption.unwrap_or_default();
            let index = if glass.absorption.is_some() {
                glass.index
            } else {
                -glass.index
            };
            (glass.share * (1.0 - metallic), [x, y, z, index])
        }
        None => (0.0, [0.0; 4]),
    };
    MaterialRecord {
        base_color: color(material.base_color),
        emission: color(material.emission),
        backing: match material.backing {
            Some([r, g, b]) => [r, g, b, 1.0],
            None => [0.0; 4],
        },
        dielectric: [r, g, b, material.dielectric.grazing],
        glass,
        metallic,
        ggx_alpha: alpha(roughness),
        surface: match material.surface {
            Surface::Diffuse => SURFACE_DIFFUSE,
            Surface::Glossy { .. } => SURFACE_GLOSSY,
            Surface::Unlit => SURFACE_UNLIT,
        },
        texture_word,
        light_density: 0.0,
        texture_queue,
        is_panel: 0,
        cutout: 0,
        transmission,
        coat: coat.strength,
        coat_alpha: alpha(coat.roughness),
        reserved: 0.0,
    }
}

fn frame_record(
    scene: &Scene,
    film_size: [u32; 2],
    options: &TraceOptions,
    world: &World,
    lights: &Lights,
) -> Result<FrameRecord, RuntimeError> {
    let light_first = index_u32(world.nodes.len());
    let environment_first = light_first + lights.count * index_u32(LIGHT_GROUPS);
    let mut environment_turn = [0.0; 4];
    let mut grid = [0; 2];
    if let Some(shown) = &lights.panorama {
        let (sine, cosine) = shown.turn_rad.sin_cos();
        environment_turn = [cosine, sine, shown.scale, shown.chance];
        grid = shown.grid;
    }
    let mut frame = FrameRecord {
        camera_position: [0.0; 4],
        camera_right: [0.0; 4],
        camera_up: [0.0; 4],
        camera_forward: [0.0; 4],
        sky_zenith: color(scene.sky.zenith),
        sky_horizon: color(scene.sky.horizon),
        sky_ground: color(scene.sky.ground),
        environment_turn,
        film_width: film_size[0],
        film_height: film_size[1],
        light_count: lights.count,
        triangle_count: world.first_level,
        seed: options.seed,
        max_bounces: options.max_bounces,
        light_sampling: options.light_sampling as u32,
        transparent_background: options.background as u32,
        camera_slope: 0.0,
        footprint_scale: options.footprint_scale,
        // The shader compares with it; infinity is not a WGSL value.
        indirect_clamp: options.indirect_clamp.min(f32::MAX),
        reach: world.reach,
        light_first,
        environment_first,
        environment_columns: grid[0],
        environment_rows: grid[1],
        albedo_first: light_first + index_u32(lights.groups.len()),
        colors_first: 0,
        reserved0: 0,
        reserved1: 0,
    };
    set_camera(&mut frame, &scene.camera)?;
    Ok(frame)
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
