//! Looking at `.vtex` files: pictures, and figures on what they hold.

pub(crate) mod film;
pub(crate) mod heat;
pub(crate) mod lookup_cost;
pub(crate) mod panorama;

use std::path::Path;

use vtex_format::{Limits, ReadError, VtexFile};
use vtex_runtime::Gpu;
use vtex_shaders::PackOptions;
use vtex_truth::texture::Shooter;

use crate::cli::lookup::Backend;
use crate::cli::{ExitCode, Failure, Outcome};
use crate::files::{BAKE_IT_FIRST, is_svg};

/// Parses the bytes of the file at `path`.
///
/// # Errors
/// The first thing that is wrong with the file.
pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Outcome<VtexFile> {
    VtexFile::parse(bytes, &Limits::default()).map_err(|error| match is_svg(path, bytes) {
        true => Failure::invalid(path, BAKE_IT_FIRST),
        false => read_failure(path, &error),
    })
}

/// The failure for a file that cannot be read.
pub(crate) fn read_failure(path: &Path, error: &ReadError) -> Failure {
    let code = match error {
        ReadError::Unsupported { .. } | ReadError::Outdated { .. } => ExitCode::Unsupported,
        ReadError::Limits { .. } => ExitCode::Limit,
        _ => ExitCode::InvalidInput,
    };
    Failure::new(code, format!("{}: {error}", path.display()))
}

/// Prepares a texture for pictures, on the CPU or on the GPU.
///
/// # Errors
/// When there is no GPU or the texture does not fit it.
pub(crate) fn shooter(file: &VtexFile, pack: PackOptions, backend: Backend) -> Outcome<Shooter> {
    match backend {
        Backend::Cpu => Ok(Shooter::on_cpu(file, pack)),
        Backend::Gpu => {
            let gpu = Gpu::headless()?;
            Ok(Shooter::on_gpu(&gpu, file, pack)?)
        }
    }
}
