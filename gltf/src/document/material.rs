//! Materials as glTF describes them. All of it is kept, also what the tracer does not show yet.

use serde::Deserialize;

use super::one;

/// A material of the asset, with every factor and texture slot that the reader knows.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Material {
    /// Its name; empty where it has none.
    pub name: String,
    /// Metallic-roughness factors and textures.
    pub pbr_metallic_roughness: MetallicRoughness,
    /// Normals in tangent space; linear data.
    pub normal_texture: Option<Slot>,
    /// Occlusion in red; linear data. A path tracer needs none.
    pub occlusion_texture: Option<Slot>,
    /// Emitted colour; sRGB.
    pub emissive_texture: Option<Slot>,
    /// Emitted radiance, before [`EmissiveStrength`].
    pub emissive_factor: [f32; 3],
    /// How alpha is read.
    pub alpha_mode: AlphaMode,
    /// The least alpha that shows with [`AlphaMode::Mask`].
    pub alpha_cutoff: f32,
    /// Whether the back is seen. The tracer shows both sides of all surfaces.
    pub double_sided: bool,
    /// What extensions add.
    pub extensions: MaterialExtensions,
}

/// The factors of the metallic-roughness model.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct MetallicRoughness {
    /// Linear colour and alpha.
    pub base_color_factor: [f32; 4],
    /// Colour and alpha; sRGB.
    pub base_color_texture: Option<Slot>,
    /// 0 for dielectrics, 1 for metals.
    pub metallic_factor: f32,
    /// Perceptual roughness.
    pub roughness_factor: f32,
    /// Roughness in green, metallic in blue; linear data.
    pub metallic_roughness_texture: Option<Slot>,
}

/// How the alpha of the base colour is read.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
pub enum AlphaMode {
    /// Not at all.
    #[default]
    Opaque,
    /// All or nothing, by [`Material::alpha_cutoff`].
    Mask,
    /// As coverage.
    Blend,
}

/// A texture in a slot of a material.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase")]
pub struct Slot {
    /// Index of the texture in the asset.
    pub index: usize,
    /// Which `TEXCOORD_n` it takes, unless [`TextureTransform::tex_coord`] says otherwise.
    #[serde(default)]
    pub tex_coord: u32,
    /// Of normal textures.
    #[serde(default = "one")]
    pub scale: f32,
    /// Of occlusion textures.
    #[serde(default = "one")]
    pub strength: f32,
    /// What extensions add.
    #[serde(default)]
    pub extensions: SlotExtensions,
}

/// Extensions of a slot.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
pub struct SlotExtensions {
    /// `KHR_texture_transform`.
    #[serde(rename = "KHR_texture_transform")]
    pub transform: Option<TextureTransform>,
}

/// `KHR_texture_transform`: uv is scaled, turned counter-clockwise, then moved.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct TextureTransform {
    /// In uv.
    pub offset: [f32; 2],
    /// In radians.
    pub rotation: f32,
    /// Along u and v.
    pub scale: [f32; 2],
    /// Instead of [`Slot::tex_coord`].
    pub tex_coord: Option<u32>,
}

/// Extensions of a material.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(default)]
pub struct MaterialExtensions {
    /// `KHR_materials_unlit`: the base colour is shown as it is.
    #[serde(rename = "KHR_materials_unlit")]
    pub unlit: Option<Unlit>,
    /// `KHR_materials_emissive_strength`.
    #[serde(rename = "KHR_materials_emissive_strength")]
    pub emissive_strength: EmissiveStrength,
    /// `KHR_materials_ior`.
    #[serde(rename = "KHR_materials_ior")]
    pub ior: Ior,
    /// `KHR_materials_transmission`.
    #[serde(rename = "KHR_materials_transmission")]
    pub transmission: Option<Transmission>,
    /// `KHR_materials_volume`.
    #[serde(rename = "KHR_materials_volume")]
    pub volume: Option<Volume>,
    /// `KHR_materials_specular`.
    #[serde(rename = "KHR_materials_specular")]
    pub specular: Option<Specular>,
    /// `KHR_materials_sheen`.
    #[serde(rename = "KHR_materials_sheen")]
    pub sheen: Option<Sheen>,
    /// `KHR_materials_clearcoat`.
    #[serde(rename = "KHR_materials_clearcoat")]
    pub clearcoat: Option<Clearcoat>,
}

/// `KHR_materials_unlit` has no settings.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
pub struct Unlit {}

/// `KHR_materials_emissive_strength`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct EmissiveStrength {
    /// Multiplies [`Material::emissive_factor`].
    pub emissive_strength: f32,
}

/// `KHR_materials_ior`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(default)]
pub struct Ior {
    /// Index of refraction.
    pub ior: f32,
}

/// `KHR_materials_transmission`.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Transmission {
    /// Share of the light that goes through.
    pub transmission_factor: f32,
    /// The same in red; linear data.
    pub transmission_texture: Option<Slot>,
}

/// `KHR_materials_volume`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Volume {
    /// Of the body behind the surface, in the mesh's space.
    pub thickness_factor: f32,
    /// The same in green; linear data.
    pub thickness_texture: Option<Slot>,
    /// At which `attenuation_color` is left; `None` is without end.
    pub attenuation_distance: Option<f32>,
    /// What white light becomes.
    pub attenuation_color: [f32; 3],
}

/// `KHR_materials_specular`.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Specular {
    /// Strength of the reflection of dielectrics.
    pub specular_factor: f32,
    /// The same in alpha; linear data.
    pub specular_texture: Option<Slot>,
    /// Its colour at normal incidence.
    pub specular_color_factor: [f32; 3],
    /// The same; sRGB.
    pub specular_color_texture: Option<Slot>,
}

/// `KHR_materials_sheen`.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Sheen {
    /// Colour of the sheen.
    pub sheen_color_factor: [f32; 3],
    /// The same; sRGB.
    pub sheen_color_texture: Option<Slot>,
    /// Roughness of the sheen.
    pub sheen_roughness_factor: f32,
    /// The same in alpha; linear data.
    pub sheen_roughness_texture: Option<Slot>,
}

/// `KHR_materials_clearcoat`.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "camelCase", default)]
pub struct Clearcoat {
    /// Strength of the coat.
    pub clearcoat_factor: f32,
    /// The same in red; linear data.
    pub clearcoat_texture: Option<Slot>,
    /// Roughness of the coat.
    pub clearcoat_roughness_factor: f32,
    /// The same in green; linear data.
    pub clearcoat_roughness_texture: Option<Slot>,
    /// Normals of the coat; linear data.
    pub clearcoat_normal_texture: Option<Slot>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            pbr_metallic_roughness: MetallicRoughness::default(),
            normal_texture: None,
            occlusion_texture: None,
            emissive_texture: None,
            emissive_factor: [0.0; 3],
            alpha_mode: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            double_sided: false,
            extensions: MaterialExtensions::default(),
        }
    }
}

impl Default for MetallicRoughness {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            base_color_texture: None,
            metallic_factor: 1.0,
            roughness_factor: 1.0,
            metallic_roughness_texture: None,
        }
    }
}

impl Default for TextureTransform {
    fn default() -> Self {
        Self {
            offset: [0.0; 2],
            rotation: 0.0,
            scale: [1.0; 2],
            tex_coord: None,
        }
    }
}

impl Default for EmissiveStrength {
    fn default() -> Self {
        Self {
            emissive_strength: 1.0,
        }
    }
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

impl Default for Volume {
    fn default() -> Self {
        Self {
            thickness_factor: 0.0,
            thickness_texture: None,
            attenuation_distance: None,
            attenuation_color: [1.0; 3],
        }
    }
}

impl Default for Specular {
    fn default() -> Self {
        Self {
            specular_factor: 1.0,
            specular_texture: None,
            specular_color_factor: [1.0; 3],
            specular_color_texture: None,
        }
    }
}

impl Slot {
    /// Which `TEXCOORD_n` counts.
    pub fn uv_set(&self) -> u32 {
        let transform = self.extensions.transform.as_ref();
        transform
            .and_then(|t| t.tex_coord)
            .unwrap_or(self.tex_coord)
    }

    /// `KHR_texture_transform` as `u' = a u + c v + e`, `v' = b u + d v + f`.
    pub fn uv_matrix(&self) -> [f32; 6] {
        let Some(transform) = &self.extensions.transform else {
            return [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        };
        let (sin, cos) = transform.rotation.sin_cos();
        let [x, y] = transform.scale;
        let [e, f] = transform.offset;
        // v grows downwards: counter-clockwise to the eye turns u towards -v.
        [cos * x, -sin * x, sin * y, cos * y, e, f]
    }
}

impl Material {
    /// Every texture slot by its name in glTF.
    pub fn slots(&self) -> Vec<(&'static str, &Slot)> {
        let pbr = &self.pbr_metallic_roughness;
        let more = &self.extensions;
        let specular = more.specular.as_ref();
        let sheen = more.sheen.as_ref();
        let coat = more.clearcoat.as_ref();
        let transmission = more.transmission.as_ref();
        let volume = more.volume.as_ref();
        let slots = [
            ("baseColorTexture", pbr.base_color_texture.as_ref()),
            (
                "metallicRoughnessTexture",
                pbr.metallic_roughness_texture.as_ref(),
            ),
            ("normalTexture", self.normal_texture.as_ref()),
            ("occlusionTexture", self.occlusion_texture.as_ref()),
            ("emissiveTexture", self.emissive_texture.as_ref()),
            (
                "transmissionTexture",
                transmission.and_then(|t| t.transmission_texture.as_ref()),
            ),
            (
                "thicknessTexture",
                volume.and_then(|v| v.thickness_texture.as_ref()),
            ),
            (
                "specularTexture",
                specular.and_then(|s| s.specular_texture.as_ref()),
            ),
            (
                "specularColorTexture",
                specular.and_then(|s| s.specular_color_texture.as_ref()),
            ),
            (
                "sheenColorTexture",
                sheen.and_then(|s| s.sheen_color_texture.as_ref()),
            ),
            (
                "sheenRoughnessTexture",
                sheen.and_then(|s| s.sheen_roughness_texture.as_ref()),
            ),
            (
                "clearcoatTexture",
                coat.and_then(|c| c.clearcoat_texture.as_ref()),
            ),
            (
                "clearcoatRoughnessTexture",
                coat.and_then(|c| c.clearcoat_roughness_texture.as_ref()),
            ),
            (
                "clearcoatNormalTexture",
                coat.and_then(|c| c.clearcoat_normal_texture.as_ref()),
            ),
        ];
        let there = slots.into_iter();
        there
            .filter_map(|(name, slot)| slot.map(|slot| (name, slot)))
            .collect()
    }
}
