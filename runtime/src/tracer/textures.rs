//! All textures of a scene with their words in one buffer and their texels in one texture.

use vtex_format::VtexFile;
use vtex_shaders::{TexelPages, pack_set, spec_key};

use crate::{LoadOptions, RuntimeError};

/// A texture starts at a multiple of this, in words: storage buffers are bound from multiples of 256
/// bytes on, and the kernel that a file carries wants its texture at the start of what is bound.
const ALIGNMENT: usize = 64;

/// The textures of a scene.
#[derive(Debug)]
pub(super) struct PackedTextures {
    pub(super) words: Vec<u32>,
    pub(super) texels: TexelPages,
    /// Where each texture lies in `words`: its first, and how many.
    pub(super) places: Vec<[u32; 2]>,
    /// Union of [`vtex_format::SpecKey::features`].
    pub(super) features: u32,
}

impl PackedTextures {
    pub(super) fn new(textures: &[(VtexFile, LoadOptions)]) -> Result<Self, RuntimeError> {
        let files = || textures.iter().map(|(file, options)| (file, &options.pack));
        let set = pack_set(files());
        let room = set.words.len() + ALIGNMENT * textures.len();
        if u32::try_from(room).is_err() {
            let message = "textures of more than 16 GiB".to_owned();
            return Err(RuntimeError::Limit(message));
        }
        let mut words = Vec::with_capacity(room);
        let mut places = Vec::with_capacity(textures.len());
        for index in 0..textures.len() {
            let own = set.of(index);
            places.push([words.len(), own.len()].map(|n| u32::try_from(n).unwrap_or(u32::MAX)));
            words.extend_from_slice(own);
            words.resize(words.len().next_multiple_of(ALIGNMENT), 0);
        }
        // One kernel serves all textures, so it needs what any of them needs. A texture without a
        // feature skips that code by its own words.
        let features = files().fold(0, |all, (file, options)| {
            all | spec_key(file, options).features
        });
        Ok(Self {
            words,
            texels: set.texels,
            places,
            features,
        })
    }
}
