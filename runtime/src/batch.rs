//! Arrays of lookups in, colours out.

use vtex_format::VtexFile;
use vtex_shaders::layout::BatchQuery;
use wgpu::{Device, Queue};

use crate::{LoadOptions, RuntimeError};

/// Whose shader text is compiled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// Ours, made from the file's key. What the file stores is only compared.
    #[default]
    Regenerate,
    /// The kernel stored in the file, after naga has validated it; ours when it is refused.
    File,
}

/// Evaluates lookups of one texture on the GPU.
#[derive(Debug)]
pub struct BatchSampler;

impl BatchSampler {
    /// Uploads the texture and compiles its kernel.
    ///
    /// # Errors
    /// As [`crate::GpuVtex::upload`].
    pub fn new(
        _device: &Device,
        _queue: &Queue,
        _file: &VtexFile,
        _options: &LoadOptions,
        _trust: Trust,
    ) -> Result<Self, RuntimeError> {
        Err(RuntimeError::Unsupported("wip".to_owned()))
    }

    /// Looks all queries up; linear light, premultiplied.
    ///
    /// # Errors
    /// [`RuntimeError::Device`] when the device is lost.
    pub fn sample(&self, _queries: &[BatchQuery]) -> Result<Vec<[f32; 4]>, RuntimeError> {
        Err(RuntimeError::Unsupported("wip".to_owned()))
    }

    /// Why the file's own shader was not used, one sentence each.
    pub fn notices(&self) -> &[String] {
        &[]
    }
}
