//! All textures of a scene in one buffer.

use vtex_format::VtexFile;

use crate::{LoadOptions, RuntimeError};

/// Several textures in one range of words.
#[derive(Debug, Default)]
pub(super) struct PackedTextures {
    /// All words.
    pub(super) words: Vec<u32>,
    /// First word of each texture.
    pub(super) first_words: Vec<u32>,
    /// Union of [`vtex_format::SpecKey::features`].
    pub(super) features: u32,
}

impl PackedTextures {
    /// Packs `textures` one after the other; their offsets are relative, so they can be moved.
    pub(super) fn new(textures: &[(VtexFile, LoadOptions)]) -> Result<Self, RuntimeError> {
        let mut packed = Self::default();
        for (file, options) in textures {
            let first = u32::try_from(packed.words.len())
                .map_err(|_| RuntimeError::Limit("textures of more than 16 GiB".to_owned()))?;
            packed.first_words.push(first);
            packed.words.extend(vtex_shaders::pack(file, &options.pack));
            // One kernel serves all textures, so it needs what any of them needs. A texture without
            // a feature skips that code by its own words.
            packed.features |= vtex_shaders::spec_key(file, &options.pack).features;
        }
        Ok(packed)
    }
}
