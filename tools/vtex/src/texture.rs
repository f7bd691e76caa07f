//! A .vtex file opened for looking at.

use std::path::Path;

use vtex_format::{AddressMode, Limits, ReadError, VtexFile};
use vtex_runtime::{BatchSampler, Gpu, LoadOptions, RuntimeError, Trust};
use vtex_shaders::layout::FilterMode;
use vtex_shaders::{PackOptions, cpu};

use crate::args::{Backend, Filter};
use crate::failure::{ExitCode, Failure, Outcome};
use crate::picture::Picture;
use crate::preview::Shot;

/// Parses the bytes of the file at `path`.
///
/// # Errors
/// The first thing wrong with the file, by whose fault it is.
pub fn parse(path: &Path, bytes: &[u8]) -> Outcome<VtexFile> {
    VtexFile::parse(bytes, &Limits::default()).map_err(|error| read_failure(path, &error))
}

/// The failure for a file that cannot be read.
pub fn read_failure(path: &Path, error: &ReadError) -> Failure {
    let code = match error {
        ReadError::Unsupported { .. } => ExitCode::Unsupported,
        ReadError::Limits { .. } => ExitCode::Limit,
        _ => ExitCode::InvalidInput,
    };
    Failure::new(code, format!("{}: {error}", path.display()))
}

/// The failure for something the GPU refused.
pub fn gpu_failure(error: &RuntimeError) -> Failure {
    let code = match error {
        RuntimeError::Limit(_) => ExitCode::Limit,
        RuntimeError::Unsupported(_) => ExitCode::Unsupported,
        RuntimeError::Parameter(_) => ExitCode::Usage,
        _ => ExitCode::Runtime,
    };
    Failure::new(code, error)
}

/// Pack options for a filter.
pub fn pack_options(filter: Filter) -> PackOptions {
    PackOptions {
        filter: match filter {
            Filter::Point => FilterMode::Point,
            Filter::Footprint => FilterMode::Footprint,
            Filter::Paper => FilterMode::Paper,
        },
        ..PackOptions::default()
    }
}

/// As [`pack_options`], showing the canvas as it is whatever texture matrix and address mode the
/// file asks for: for comparisons with the drawing.
pub fn canvas_options(filter: Filter) -> PackOptions {
    PackOptions {
        address: Some([AddressMode::Clamp; 2]),
        texture_matrix: Some([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        ..pack_options(filter)
    }
}

/// Takes pictures of one texture.
#[derive(Debug)]
pub enum Shooter {
    /// With the evaluator in Rust.
    Cpu {
        /// The packed texture.
        words: Vec<u32>,
    },
    /// With the evaluator in WGSL.
    Gpu {
        /// The uploaded texture; boxed, for it is large.
        sampler: Box<BatchSampler>,
    },
}

impl Shooter {
    /// Prepares a texture for pictures.
    ///
    /// # Errors
    /// When there is no GPU or the texture does not fit it.
    pub fn new(file: &VtexFile, pack: PackOptions, backend: Backend) -> Outcome<Self> {
        match backend {
            Backend::Cpu => Ok(Self::Cpu {
                words: vtex_shaders::pack(file, &pack),
            }),
            Backend::Gpu => {
                let gpu = Gpu::headless().map_err(|error| gpu_failure(&error))?;
                Self::on_gpu(&gpu, file, pack)
            }
        }
    }

    /// Prepares a texture for pictures on a GPU that is open already.
    ///
    /// # Errors
    /// When the texture does not fit the GPU.
    pub fn on_gpu(gpu: &Gpu, file: &VtexFile, pack: PackOptions) -> Outcome<Self> {
        let options = LoadOptions { pack };
        let trust = Trust::default();
        let sampler = BatchSampler::new(&gpu.device, &gpu.queue, file, &options, trust)
            .map_err(|error| gpu_failure(&error))?;
        Ok(Self::Gpu {
            sampler: Box::new(sampler),
        })
    }

    /// Takes a picture.
    ///
    /// # Errors
    /// When the GPU fails.
    pub fn shoot(&self, shot: Shot) -> Outcome<Picture> {
        match self {
            Self::Cpu { words } => {
                let sampler = cpu::Sampler::new(words);
                Ok(shot.shoot(|uv, footprint| sampler.sample(uv, footprint)))
            }
            Self::Gpu { sampler } => shot
                .shoot_batches(|queries| sampler.sample(queries))
                .map_err(|error| gpu_failure(&error)),
        }
    }
}
