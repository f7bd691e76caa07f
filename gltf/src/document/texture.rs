//! Textures, images and samplers.

use serde::Deserialize;
use vtex_format::AddressMode;

#[derive(Debug, Deserialize)]
pub(crate) struct Texture {
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) sampler: Option<usize>,
    pub(crate) source: Option<usize>,
    #[serde(default)]
    pub(crate) extensions: TextureExtensions,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct TextureExtensions {
    #[serde(rename = "EXT_texture_webp")]
    pub(crate) webp: Option<Webp>,
    #[serde(rename = "VTEX_texture_vector")]
    pub(crate) vector: Option<Vector>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct Webp {
    pub(crate) source: usize,
}

/// A drawing instead of the image, or a baked file: docs/gltf.md.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Vector {
    pub(crate) uri: Option<String>,
    pub(crate) buffer_view: Option<usize>,
    pub(crate) mime_type: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Image {
    pub(crate) uri: Option<String>,
    pub(crate) buffer_view: Option<usize>,
    #[serde(default)]
    pub(crate) name: String,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Sampler {
    pub(crate) mag_filter: Option<u32>,
    #[serde(default = "repeat")]
    pub(crate) wrap_s: u32,
    #[serde(default = "repeat")]
    pub(crate) wrap_t: u32,
}

const CLAMP_TO_EDGE: u32 = 33_071;
const MIRRORED_REPEAT: u32 = 33_648;
const REPEAT: u32 = 10_497;
const NEAREST: u32 = 9728;

fn repeat() -> u32 {
    REPEAT
}

impl Sampler {
    /// Address modes along u and v; `None` for a number that glTF does not have.
    pub(crate) fn address(&self) -> Option<[AddressMode; 2]> {
        let mode = |wrap: u32| match wrap {
            CLAMP_TO_EDGE => Some(AddressMode::Clamp),
            MIRRORED_REPEAT => Some(AddressMode::Mirror),
            REPEAT => Some(AddressMode::Repeat),
            _ => None,
        };
        Some([mode(self.wrap_s)?, mode(self.wrap_t)?])
    }

    pub(crate) fn is_nearest(&self) -> bool {
        self.mag_filter == Some(NEAREST)
    }
}
