//! The JSON of an asset, as far as it is read.

pub mod material;
pub(crate) mod texture;

use serde::Deserialize;

use crate::error::{GltfError, Outcome, malformed};
use material::Material;
use texture::{Image, Sampler, Texture};

/// Extensions that are read.
const KNOWN: [&str; 15] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "VTEX_texture_vector",
];

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Document {
    pub(crate) asset: AssetInfo,
    #[serde(default)]
    extensions_used: Vec<String>,
    #[serde(default)]
    extensions_required: Vec<String>,
    #[serde(default)]
    pub(crate) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(crate) buffers: Vec<Buffer>,
    #[serde(default)]
    pub(crate) buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub(crate) cameras: Vec<Camera>,
    #[serde(default)]
    pub(crate) images: Vec<Image>,
    #[serde(default)]
    pub(crate) materials: Vec<Material>,
    #[serde(default)]
    pub(crate) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(crate) nodes: Vec<Node>,
    #[serde(default)]
    pub(crate) samplers: Vec<Sampler>,
    #[serde(default)]
    pub(crate) scenes: Vec<Scene>,
    pub(crate) scene: Option<usize>,
    #[serde(default)]
    pub(crate) textures: Vec<Texture>,
    #[serde(default)]
    pub(crate) extensions: DocumentExtensions,
    #[serde(default)]
    pub(crate) animations: Vec<serde::de::IgnoredAny>,
    #[serde(default)]
    pub(crate) skins: Vec<serde::de::IgnoredAny>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct AssetInfo {
    version: String,
    min_version: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct DocumentExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(crate) lights: Lights,
    #[serde(rename = "KHR_materials_variants")]
    pub(crate) variants: Variants,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Lights {
    pub(crate) lights: Vec<Light>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Light {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(rename = "type")]
    pub(crate) kind: String,
    #[serde(default = "white")]
    pub(crate) color: [f32; 3],
    #[serde(default = "one")]
    pub(crate) intensity: f32,
    pub(crate) range: Option<f32>,
    #[serde(default)]
    pub(crate) spot: Spot,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub(crate) struct Spot {
    pub(crate) inner_cone_angle: f32,
    pub(crate) outer_cone_angle: f32,
}

impl Default for Spot {
    fn default() -> Self {
        Self {
            inner_cone_angle: 0.0,
            outer_cone_angle: std::f32::consts::FRAC_PI_4,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Variants {
    pub(crate) variants: Vec<Variant>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Variant {
    pub(crate) name: String,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Buffer {
    pub(crate) uri: Option<String>,
    pub(crate) byte_length: u64,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct BufferView {
    pub(crate) buffer: usize,
    #[serde(default)]
    pub(crate) byte_offset: u64,
    pub(crate) byte_length: u64,
    pub(crate) byte_stride: Option<u64>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Accessor {
    pub(crate) buffer_view: Option<usize>,
    #[serde(default)]
    pub(crate) byte_offset: u64,
    pub(crate) component_type: u32,
    #[serde(default)]
    pub(crate) normalized: bool,
    pub(crate) count: u64,
    #[serde(rename = "type")]
    pub(crate) kind: String,
    pub(crate) sparse: Option<Sparse>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Sparse {
    pub(crate) count: u64,
    pub(crate) indices: SparsePart,
    pub(crate) values: SparsePart,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparsePart {
    pub(crate) buffer_view: usize,
    #[serde(default)]
    pub(crate) byte_offset: u64,
    pub(crate) component_type: Option<u32>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Camera {
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) perspective: Option<Perspective>,
    pub(crate) orthographic: Option<Orthographic>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Perspective {
    pub(crate) yfov: f32,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Orthographic {
    pub(crate) ymag: f32,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Mesh {
    #[serde(default)]
    pub(crate) primitives: Vec<Primitive>,
    #[serde(default)]
    pub(crate) name: String,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Primitive {
    #[serde(default)]
    pub(crate) attributes: std::collections::BTreeMap<String, usize>,
    pub(crate) indices: Option<usize>,
    pub(crate) material: Option<usize>,
    pub(crate) mode: Option<u32>,
    #[serde(default)]
    pub(crate) targets: Vec<serde::de::IgnoredAny>,
    #[serde(default)]
    pub(crate) extensions: PrimitiveExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct PrimitiveExtensions {
    #[serde(rename = "KHR_materials_variants")]
    pub(crate) variants: Mappings,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Mappings {
    pub(crate) mappings: Vec<Mapping>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Mapping {
    pub(crate) material: usize,
    #[serde(default)]
    pub(crate) variants: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Scene {
    #[serde(default)]
    pub(crate) nodes: Vec<usize>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Node {
    #[serde(default)]
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) children: Vec<usize>,
    pub(crate) mesh: Option<usize>,
    pub(crate) camera: Option<usize>,
    pub(crate) matrix: Option<[f32; 16]>,
    pub(crate) translation: Option<[f32; 3]>,
    pub(crate) rotation: Option<[f32; 4]>,
    pub(crate) scale: Option<[f32; 3]>,
    #[serde(default)]
    pub(crate) extensions: NodeExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(crate) light: Option<LightOfNode>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(crate) instancing: Option<Instancing>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct LightOfNode {
    pub(crate) light: usize,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Instancing {
    #[serde(default)]
    pub(crate) attributes: std::collections::BTreeMap<String, usize>,
}

pub(crate) fn one() -> f32 {
    1.0
}

pub(crate) fn white() -> [f32; 3] {
    [1.0; 3]
}

impl Document {
    /// Parses and checks version and extensions. What is used and not known goes to `warnings`.
    pub(crate) fn parse(json: &[u8], warnings: &mut Vec<String>) -> Outcome<Self> {
        let document: Self = match serde_json::from_slice(json) {
            Ok(document) => document,
            Err(error) => return malformed("JSON", error),
        };
        let info = &document.asset;
        let needed = info.min_version.as_ref().unwrap_or(&info.version);
        let is_known = match &info.min_version {
            Some(least) => least == "2.0",
            None => needed.starts_with("2."),
        };
        if !is_known {
            let message = format!("asset.version: {needed}; this reader knows glTF 2.0");
            return Err(GltfError::Unsupported(message));
        }
        let unknown = |name: &&String| !KNOWN.contains(&name.as_str());
        let required = document.extensions_required.iter();
        let required: Vec<&str> = required.filter(unknown).map(String::as_str).collect();
        if !required.is_empty() {
            let message = format!("extensionsRequired: {}", required.join(", "));
            return Err(GltfError::Unsupported(message));
        }
        for name in document.extensions_used.iter().filter(unknown) {
            warnings.push(format!(
                "extensionsUsed: {name} is not known and was left out"
            ));
        }
        if !document.animations.is_empty() {
            warnings.push("animations: the pose of the nodes themselves is shown".to_owned());
        }
        if !document.skins.is_empty() {
            warnings.push("skins: meshes are shown in the pose they are stored in".to_owned());
        }
        Ok(document)
    }
}
