//! Textures of a set straight from the bytes of files.

use vtex_format::Limits;
use vtex_shaders::load_in_pages;
use vtex_shaders::set::TextureHandle;

use super::TextureSet;
use super::pools::Made;
use crate::{LoadOptions, RuntimeError};

impl TextureSet {
    /// Reads a file and adds it. As [`TextureSet::load_all`].
    ///
    /// # Errors
    /// As [`TextureSet::load_all_async`].
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn load(
        &mut self,
        bytes: &[u8],
        limits: &Limits,
        options: &LoadOptions,
    ) -> Result<TextureHandle, RuntimeError> {
        let added = self.load_all([(bytes, options)], limits)?;
        Ok(added.first().copied().unwrap_or_default())
    }

    /// Reads files by all cores and adds them: a handle for each, in order, or none of them.
    ///
    /// A file of `vtex bake --profile load` is read several times as fast as by
    /// [`VtexFile::parse`](vtex_format::VtexFile::parse) and [`TextureSet::add_all`], since it need not be
    /// decoded whole; others as fast as by those.
    ///
    /// # Errors
    /// As [`TextureSet::load_all_async`].
    #[cfg(all(feature = "blocking", not(target_arch = "wasm32")))]
    pub fn load_all<'a>(
        &mut self,
        textures: impl IntoIterator<Item = (&'a [u8], &'a LoadOptions)>,
        limits: &Limits,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let device = self.device.clone();
        crate::device::block_on(&device, self.load_all_async(textures, limits))
    }

    /// As `TextureSet::load_all`, for callers that must not block. Where the future is dropped before its
    /// end, the set stays as it was.
    ///
    /// # Errors
    /// [`RuntimeError::FileOf`] for the first of them that is no file or asks for more than `limits`, and
    /// those of [`TextureSet::add_all_async`].
    pub async fn load_all_async<'a>(
        &mut self,
        textures: impl IntoIterator<Item = (&'a [u8], &'a LoadOptions)>,
        limits: &Limits,
    ) -> Result<Vec<TextureHandle>, RuntimeError> {
        let textures: Vec<_> = textures.into_iter().enumerate().collect();
        self.add_made(&textures, |&(index, (bytes, options)), page_side| {
            let loaded = load_in_pages(bytes, limits, &options.pack, page_side)
                .map_err(|source| RuntimeError::FileOf { index, source })?;
            Ok(Made {
                packed: loaded.packed,
                features: loaded.key.features,
            })
        })
        .await
    }
}
