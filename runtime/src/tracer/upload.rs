//! A scene as buffers on the device.

use glam::{Affine3A, Vec3, Vec3A, Vec4};
use obvhs::triangle::Triangle;
use wgpu::{Buffer, BufferUsages, Device, Queue};

use super::queues::TextureQueues;
use super::records::{
    AttributeRecord, FrameRecord, LightRecord, MaterialRecord, NONE, SURFACE_DIFFUSE,
    SURFACE_GLOSSY, TriangleRecord,
};
use super::textures::PackedTextures;
use super::{TraceOptions, bvh};
use crate::RuntimeError;
use crate::device::{Uploaded, checked, filled_buffer};
use crate::scene::{
    Camera, Instance, MAX_LIGHTS, MAX_TRIANGLES, Material, RectLight, Scene, Surface,
};

/// Deepest hierarchy the shader's stack holds; see `STACK_SIZE` there.
const MAX_BVH_DEPTH: usize = 32;
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
    source_triangles: Vec<u32>,
}

/// All triangles in world space with what shading needs, in scene order.
#[derive(Debug, Default)]
struct World {
    triangles: Vec<Triangle>,
    attributes: Vec<AttributeRecord>,
    /// Whether each may let rays through.
    is_veil: Vec<bool>,
}

impl SceneBuffers {
    pub(super) async fn upload(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        options: &TraceOptions,
    ) -> Result<Self, RuntimeError> {
        let world = World::new(scene)?;
        let bvh = bvh::build(&world.triangles);
        let depth = bvh::depth(&bvh);
        if depth > MAX_BVH_DEPTH {
            return Err(RuntimeError::Limit(format!(
                "BVH of {depth} levels: is the mesh degenerate?"
            )));
        }
        // In the order of the hierarchy, so that a leaf is a first index and a count.
        let order = &bvh.primitive_indices;
        let triangles: Vec<TriangleRecord> = order
            .iter()
            .map(|&i| TriangleRecord::new(&world.triangles[i as usize], world.is_veil[i as usize]))
            .collect();
        let attributes: Vec<AttributeRecord> = order
            .iter()
            .map(|&i| world.attributes[i as usize])
            .collect();
        let packed = PackedTextures::new(&scene.textures)?;
        let queues = TextureQueues::new(&scene.textures, options.trust);
        let lookups: Vec<[u32; 2]> = (packed.places.iter().map(|[first, _]| *first))
            .zip(queues.of_texture.iter().copied())
            .map(<[u32; 2]>::from)
            .collect();
        let materials = material_records(scene, &lookups);
        let frame_record = frame_record(scene, size, options, &triangles)?;
        checked(device, "scene", || {
            let filled =
                |label, bytes: &[u8], usage| filled_buffer(device, queue, label, bytes, usage);
            let storage = |label, bytes: &[u8]| filled(label, bytes, BufferUsages::STORAGE);
            let frame = bytemuck::bytes_of(&frame_record);
            Ok(Self {
                frame: filled("vtex frame", frame, BufferUsages::UNIFORM)?,
                frame_record,
                nodes: storage("vtex BVH nodes", bytemuck::cast_slice(&bvh.nodes))?,
                triangles: storage("vtex triangles", bytemuck::cast_slice(&triangles))?,
                attributes: storage("vtex attributes", bytemuck::cast_slice(&attributes))?,
                materials: storage("vtex materials", bytemuck::cast_slice(&materials))?,
                textures: Uploaded::new(device, queue, &packed.words, &packed.texels)?,
                texture_features: packed.features,
                texture_places: packed.places,
                queues,
                has_veils: world.is_veil.contains(&true),
                source_triangles: bvh.primitive_indices,
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

    pub(super) fn triangle_count(&self) -> u32 {
        self.frame_record.triangle_count
    }

    /// Scene order of a triangle in BVH order.
    pub(super) fn source_triangle(&self, index: u32) -> u32 {
        self.source_triangles
            .get(index as usize)
            .copied()
            .unwrap_or(NONE)
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

impl World {
    fn new(scene: &Scene) -> Result<Self, RuntimeError> {
        let mut world = Self::default();
        // Counted before anything is placed: a small mesh with many instances must not fill memory.
        let placed: usize = scene
            .instances
            .iter()
            .map(|instance| scene.meshes[instance.mesh].triangles.len())
            .sum();
        if placed > MAX_TRIANGLES {
            return Err(RuntimeError::Limit(format!(
                "{placed} triangles; a scene holds at most {MAX_TRIANGLES}"
            )));
        }
        for instance in &scene.instances {
            world.place(scene, instance);
        }
        // Each light has a material of its own behind the scene's, see `material_records`.
        for (light, material) in scene.lights.iter().zip(scene.materials.len()..) {
            world.place_light(light, index_u32(material));
        }
        Ok(world)
    }

    fn place(&mut self, scene: &Scene, instance: &Instance) {
        let mesh = &scene.meshes[instance.mesh];
        let material = &scene.materials[instance.material];
        let is_veil = material.texture.is_some() && material.backing.is_none();
        let to_world = Affine3A::from_cols_array_2d(&instance.world_from_object);
        // Inverse transpose: normals stay at right angles to surfaces that are stretched. A matrix
        // without an inverse gives no numbers, and those become normals of length 0.
        let normal_to_world = to_world.matrix3.inverse().transpose();
        for indices in &mesh.triangles {
            let corners = indices.map(|i| i as usize);
            let triangle = bvh::triangle(
                corners.map(|i| to_world.transform_point3a(mesh.positions[i].into())),
            );
            let normals = corners.map(|i| {
                let normal = normal_to_world * Vec3A::from(mesh.normals[i]);
                normal.normalize_or_zero()
            });
            let uvs = corners.map(|i| mesh.uvs[i]);
            self.triangles.push(triangle);
            self.is_veil.push(is_veil);
            self.attributes.push(attribute_record(
                [0, 1, 2].map(|k| normals[k].extend(uvs[k][0])),
                uvs.map(|[_, v]| v),
                index_u32(instance.material),
            ));
        }
    }

    /// Lights are met by chance too, so they are geometry: two triangles, counter-clockwise seen
    /// from where they shine.
    fn place_light(&mut self, light: &RectLight, material: u32) {
        let [corner, edge_u, edge_v] = light_vectors(light);
        let normal = edge_u.cross(edge_v).normalize_or_zero();
        let at = |u: f32, v: f32| Vec3A::from(corner + edge_u * u + edge_v * v);
        for corners in [
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            [at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        ] {
            self.triangles.push(bvh::triangle(corners));
            self.is_veil.push(false);
            self.attributes.push(attribute_record(
                [normal.extend(0.0); 3],
                [0.0; 3],
                material,
            ));
        }
    }
}

fn attribute_record(normal_u: [Vec4; 3], [v0, v1, v2]: [f32; 3], material: u32) -> AttributeRecord {
    let [normal0_u, normal1_u, normal2_u] = normal_u.map(|n| n.to_array());
    AttributeRecord {
        normal0_u,
        normal1_u,
        normal2_u,
        // The index as bits. The shader only reinterprets them: small ones are denormal numbers, which
        // arithmetic may flush to zero.
        v_material: [v0, v1, v2, f32::from_bits(material)],
    }
}

impl TriangleRecord {
    fn new(triangle: &Triangle, is_veil: bool) -> Self {
        let word = |v: Vec3A| v.extend(0.0).to_array();
        let veil = if is_veil { 1.0 } else { 0.0 };
        Self {
            v0: triangle.v0.extend(veil).to_array(),
            // Signs and operations as in obvhs, whose CPU traversal must give the same bits.
            edge1: word(triangle.v0 - triangle.v1),
            edge2: word(triangle.v2 - triangle.v0),
        }
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
    triangles: &[TriangleRecord],
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
        triangle_count: index_u32(triangles.len()),
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

/// Counts here are bounded by [`MAX_TRIANGLES`] and by memory.
fn index_u32(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(NONE)
}
