//! Errors while a picture is drawn, taken or encoded.

use vtex_runtime::RuntimeError;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TruthError {
    /// The pixels do not fit into memory.
    #[error("not enough memory for the picture")]
    Memory,
    /// The PNG encoder refused the picture.
    #[error("cannot encode PNG: {0}")]
    Png(#[from] png::EncodingError),
    /// The GPU failed, or the texture does not fit into its limits.
    #[error("{0}")]
    Gpu(#[from] RuntimeError),
}
