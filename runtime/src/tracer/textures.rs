//! All textures of a scene with their words in one buffer and their texels in one texture.

use vtex_format::VtexFile;
use vtex_shaders::{PackedSet, pack_set, spec_key};

use crate::{LoadOptions, RuntimeError};

/// The textures of a scene.
#[derive(Debug)]
pub(super) struct PackedTextures {
    pub(super) set: PackedSet,
    /// Union of [`vtex_format::SpecKey::features`].
    pub(super) features: u32,
}

impl PackedTextures {
    pub(super) fn new(textures: &[(VtexFile, LoadOptions)]) -> Result<Self, RuntimeError> {
        let files = || textures.iter().map(|(file, options)| (file, &options.pack));
        let set = pack_set(files());
        if u32::try_from(set.words.len()).is_err() {
            let message = "textures of more than 16 GiB".to_owned();
            return Err(RuntimeError::Limit(message));
        }
        // One kernel serves all textures, so it needs what any of them needs. A texture without a
        // feature skips that code by its own words.
        let features = files().fold(0, |all, (file, options)| {
            all | spec_key(file, options).features
        });
        Ok(Self { set, features })
    }
}
