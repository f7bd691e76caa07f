//! What a caller may decide about a set, and what the device decides.

use vtex_format::Features;
use vtex_shaders::MAX_PAGE_SIDE;
use vtex_shaders::layout::FilterMode;
use vtex_shaders::set::{MAX_POOLS, every_feature};
use wgpu::Device;

use super::pages::PageLimits;
use super::space::Bounds;
use crate::{RuntimeError, TexelFormat};

/// The table has the first word of a texture as a `u32`.
const COUNTED_BYTES: u64 = 1 << 34;

/// What a caller may decide about a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureSetOptions {
    /// Features that the text has code for from the start, bits of [`vtex_format::Features`]. Those of
    /// textures are added when they are. With [`TextureSetOptions::every_feature`] the text never changes.
    pub features: u32,
    /// Sides up to which a page of texels grows before there is a second, at most
    /// [`MAX_PAGE_SIDE`](vtex_shaders::MAX_PAGE_SIDE). A level of an image that is larger makes the pages
    /// larger, all those of its pool. A pool has at most 64: 1 GiB of texels with the default, 2048.
    pub page_side: u32,
    /// How texels lie on the device.
    pub texels: TexelFormat,
    /// How many threads pack textures, 0 for one a core. A browser has one.
    pub threads: usize,
    /// How many pools the set may have, from 1 to 32, each with a bind group of its own. The default is 1: one
    /// bind group has every texture, and the set is full where that is. With more, draw each texture with
    /// [`TextureSet::bind_group_of`](super::TextureSet::bind_group_of) its handle.
    pub max_pools: u32,
    /// Bytes of words in a pool, at most; the default is what the device binds, 128 MiB on core WebGPU. A pool
    /// that grows is copied, so that smaller ones take less at a time.
    pub pool_bytes: u64,
    /// Bytes of all textures, words and texels ([`SetBytes`](super::SetBytes) counts them), at most. There is
    /// no limit by default, and WebGPU does not tell how much memory there is.
    pub max_bytes: u64,
}

impl Default for TextureSetOptions {
    fn default() -> Self {
        Self {
            features: 0,
            page_side: 2048,
            texels: TexelFormat::Rgba8,
            threads: 0,
            max_pools: 1,
            pool_bytes: u64::MAX,
            max_bytes: u64::MAX,
        }
    }
}

impl TextureSetOptions {
    /// A text that serves every texture in a filter mode, so that no texture ever asks for another. It is
    /// larger, and slower where it takes more registers than the textures at hand need. A software driver,
    /// which runs all code of a lookup, takes about ten times as long.
    pub fn every_feature(filter: FilterMode) -> Self {
        Self {
            features: every_feature(filter),
            ..Self::default()
        }
    }

    /// # Errors
    /// [`RuntimeError::Parameter`] for a value out of its range.
    pub(super) fn check(&self) -> Result<(), RuntimeError> {
        let refused = |text: String| Err(RuntimeError::Parameter(text));
        if !(1..=MAX_POOLS).contains(&self.max_pools) {
            let pools = self.max_pools;
            return refused(format!("`max_pools` is {pools}: from 1 to {MAX_POOLS}"));
        }
        if !(1..=MAX_PAGE_SIDE).contains(&self.page_side) {
            let side = self.page_side;
            return refused(format!("`page_side` is {side}: from 1 to {MAX_PAGE_SIDE}"));
        }
        if self.features & !Features::ALL != 0 {
            let features = self.features;
            return refused(format!(
                "`features` is {features:#x}: bits of `Features`, {:#x} in all; \
                 `TextureSetOptions::every_feature` has those of a filter mode",
                Features::ALL
            ));
        }
        Ok(())
    }

    /// How many pools there may be.
    pub(super) fn most_pools(&self) -> u32 {
        self.max_pools.clamp(1, MAX_POOLS)
    }

    /// What bounds a pool. `nothing_words`: of the texture that shows nothing.
    pub(super) fn bounds(&self, device: &Device, nothing_words: usize) -> Bounds {
        let limits = device.limits();
        Bounds {
            buffer_bytes: limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size)
                .min(self.pool_bytes)
                .min(COUNTED_BYTES),
            pages: PageLimits {
                side: self.page_side.clamp(1, limits.max_texture_dimension_2d),
                device_side: limits.max_texture_dimension_2d,
                device_layers: limits.max_texture_array_layers,
            },
            nothing_words,
        }
    }
}
