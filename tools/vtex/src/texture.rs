//! A .vtex file opened for looking at.

use std::path::Path;

use vtex_format::{Limits, ReadError, VtexFile};
use vtex_runtime::{Gpu, RuntimeError};
use vtex_shaders::PackOptions;
use vtex_truth::texture::Shooter;

use crate::args::Backend;
use crate::failure::{ExitCode, Failure, Outcome};

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

/// Prepares a texture for pictures by whoever the command line names.
///
/// # Errors
/// When there is no GPU or the texture does not fit it.
pub fn shooter(file: &VtexFile, pack: PackOptions, backend: Backend) -> Outcome<Shooter> {
    match backend {
        Backend::Cpu => Ok(Shooter::on_cpu(file, pack)),
        Backend::Gpu => {
            let gpu = Gpu::headless().map_err(|error| gpu_failure(&error))?;
            Ok(Shooter::on_gpu(&gpu, file, pack)?)
        }
    }
}
