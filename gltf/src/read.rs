//! From bytes to a scene.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::Affine3A;
use vtex_runtime::{Instance, Mesh, Scene, Sky};

use crate::buffers::accessor::{MOST_ELEMENTS, Reader};
use crate::buffers::glb;
use crate::buffers::source::{Buffers, Files};
use crate::document::material::Material;
use crate::document::{Document, Primitive};
use crate::error::{GltfError, Outcome, find};
use crate::geometry::{self, Attributes};
use crate::nodes::{self, NamedCamera, Placed, PunctualLight};
use crate::texture::Textures;
use crate::{surface, view_of};

/// What of an asset is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Index of the scene; `None` for the one that the asset shows.
    pub scene: Option<usize>,
    /// A variant of `KHR_materials_variants` by its name.
    pub variant: Option<String>,
}

/// An asset, read.
#[derive(Clone, Debug)]
pub struct Asset {
    /// What the tracer shows of it. Its camera is the first of `cameras`, or [`view_of`] the scene on a
    /// square film.
    pub scene: Scene,
    /// Cameras in the order of the nodes.
    pub cameras: Vec<NamedCamera>,
    /// Punctual lights in the order of the nodes; the tracer shows them.
    pub lights: Vec<PunctualLight>,
    /// All materials as the asset describes them.
    pub materials: Vec<Material>,
    /// For each of `scene.meshes`, where it comes from and what else it has.
    pub primitives: Vec<PrimitiveInfo>,
    /// Names of variants.
    pub variants: Vec<String>,
    /// What was mended, and what is kept here and not shown.
    pub warnings: Vec<String>,
}

/// What a primitive has besides its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveInfo {
    /// Name of the mesh; may be empty.
    pub name: String,
    /// Index into [`Asset::materials`]; `None` for glTF's default material.
    pub material: Option<usize>,
    /// Its other attributes.
    pub attributes: Attributes,
}

/// Reads a `.glb` or `.gltf` file.
///
/// # Errors
/// [`GltfError`], which names the place in the file. What can be mended or left out is a warning.
pub fn read(
    bytes: &[u8],
    files: &mut dyn Files,
    options: &ReadOptions,
) -> Result<Asset, GltfError> {
    let parts = glb::split(bytes)?;
    let mut warnings = Vec::new();
    let document = Document::parse(parts.json, &mut warnings)?;
    let variant = variant(&document, options)?;
    let buffers = Buffers::new(&document, parts.bin, files)?;
    let mut reader = Reader {
        document: &document,
        buffers: &buffers,
        left: MOST_ELEMENTS,
    };
    if document.scenes.is_empty() {
        let message = "the asset has no scene, so there is nothing to show".to_owned();
        return Err(GltfError::Unsupported(message));
    }
    let scene = options.scene.or(document.scene).unwrap_or(0);
    let placed = nodes::walk(&mut reader, scene, &mut warnings)?;
    let built = Built::new(&mut reader, &placed, variant, &mut warnings)?;
    let mut textures = Textures::new(&reader, files);
    let mut materials = Vec::new();
    let default = Material::default();
    for &material in &built.materials {
        let (place, material) = match material {
            Some(index) => {
                let material = &document.materials[index];
                let name = match material.name.is_empty() {
                    true => String::new(),
                    false => format!(" {:?}", material.name),
                };
                (format!("materials[{index}]{name}"), material)
            }
            None => (String::new(), &default),
        };
        materials.push(surface::traced(
            material,
            &place,
            &mut textures,
            &mut warnings,
        )?);
    }
    let mut scene = Scene {
        meshes: built.meshes,
        instances: built.instances,
        materials,
        textures: textures.made,
        // White from everywhere shows colours as they are, unless the asset says what lights it.
        sky: Sky::uniform(if placed.lights.is_empty() { 1.0 } else { 0.0 }),
        environment: None,
        lights: Vec::new(),
        punctual: (placed.lights.iter())
            .filter_map(|light| light.traced(&mut warnings))
            .collect(),
        camera: vtex_runtime::Camera::facing_rect([0.0; 2], [1.0; 2], 1.0),
    };
    scene.camera = match placed.cameras.first() {
        Some(first) => first.camera,
        None => view_of(&scene, 1.0),
    };
    let variants = &document.extensions.variants.variants;
    Ok(Asset {
        scene,
        cameras: placed.cameras,
        lights: placed.lights,
        variants: variants
            .iter()
            .map(|variant| variant.name.clone())
            .collect(),
        materials: document.materials,
        primitives: built.primitives,
        warnings,
    })
}

fn variant(document: &Document, options: &ReadOptions) -> Outcome<Option<usize>> {
    let Some(name) = &options.variant else {
        return Ok(None);
    };
    let variants = &document.extensions.variants.variants;
    match variants.iter().position(|variant| variant.name == *name) {
        Some(index) => Ok(Some(index)),
        None => {
            let names: Vec<&str> = variants.iter().map(|v| v.name.as_str()).collect();
            let message = format!("no variant {name:?}; there are {names:?}");
            Err(GltfError::Parameter(message))
        }
    }
}

/// Meshes and instances. Primitives that nodes share are one mesh.
#[derive(Default)]
struct Built {
    meshes: Vec<Mesh>,
    primitives: Vec<PrimitiveInfo>,
    instances: Vec<Instance>,
    /// Materials of the asset that instances name, in the order of the scene's.
    materials: Vec<Option<usize>>,
}

impl Built {
    fn new(
        reader: &mut Reader<'_>,
        placed: &Placed,
        variant: Option<usize>,
        warnings: &mut Vec<String>,
    ) -> Outcome<Self> {
        let document = reader.document;
        let mut built = Self::default();
        let mut known: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for &(mesh, transform) in &placed.meshes {
            let parts = match known.entry(mesh) {
                Entry::Occupied(parts) => parts.into_mut(),
                Entry::Vacant(place) => {
                    place.insert(built.add_mesh(reader, mesh, variant, warnings)?)
                }
            };
            for &(part, material) in &*parts {
                built.instances.push(Instance {
                    mesh: part,
                    material,
                    world_from_object: Affine3A::to_cols_array_2d(&transform),
                });
            }
        }
        let placed = built.instances.len();
        if placed == 0 {
            let scenes = document.scenes.len();
            warnings.push(format!("nothing to see in the scene, of {scenes}"));
        }
        Ok(built)
    }

    /// The mesh and material in the scene of each primitive.
    fn add_mesh(
        &mut self,
        reader: &mut Reader<'_>,
        mesh: usize,
        variant: Option<usize>,
        warnings: &mut Vec<String>,
    ) -> Outcome<Vec<(usize, usize)>> {
        let document = reader.document;
        let mut parts = Vec::new();
        for (index, primitive) in document.meshes[mesh].primitives.iter().enumerate() {
            let place = format!("meshes[{mesh}].primitives[{index}]");
            let Some((mut shape, attributes)) =
                geometry::read(reader, primitive, &place, warnings)?
            else {
                continue;
            };
            let material = material_of(primitive, variant);
            let uv_set = match material {
                Some(index) => {
                    let material = find(&document.materials, index, "materials", &place)?;
                    let slot = material.pbr_metallic_roughness.base_color_texture.as_ref();
                    slot.map_or(0, |slot| slot.uv_set())
                }
                None => 0,
            };
            match attributes.uvs.get(uv_set as usize) {
                Some(uvs) if !uvs.is_empty() => shape.uvs.clone_from(uvs),
                Some(_) if material.is_none() || uv_set == 0 => (),
                _ => warnings.push(format!("{place}: it has no TEXCOORD_{uv_set} to show")),
            }
            let shade = |[r, g, b, _]: &[f32; 4]| [*r, *g, *b].map(|c| c.clamp(0.0, 1.0));
            shape.colors = attributes.colors.iter().map(shade).collect();
            if attributes.colors.iter().any(|[.., alpha]| *alpha < 1.0) {
                warnings.push(format!(
                    "{place}: the alpha of COLOR_0 is kept and not shown"
                ));
            }
            self.meshes.push(shape);
            self.primitives.push(PrimitiveInfo {
                name: document.meshes[mesh].name.clone(),
                material,
                attributes,
            });
            parts.push((self.meshes.len() - 1, self.scene_material(material)));
        }
        Ok(parts)
    }

    fn scene_material(&mut self, material: Option<usize>) -> usize {
        let known = self.materials.iter().position(|&known| known == material);
        known.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        })
    }
}

fn material_of(primitive: &Primitive, variant: Option<usize>) -> Option<usize> {
    let mappings = &primitive.extensions.variants.mappings;
    let of_variant = variant.and_then(|variant| {
        mappings
            .iter()
            .find(|mapping| mapping.variants.contains(&variant))
    });
    of_variant
        .map(|mapping| mapping.material)
        .or(primitive.material)
}
