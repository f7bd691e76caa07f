//! Why something could not be loaded or rendered, and who must act.

/// Every error of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RuntimeError {
    /// No adapter, or none that matches what was asked for: install a driver or change the wish.
    #[error("no usable GPU adapter: {0}")]
    NoAdapter(String),
    /// The device refused, failed or was lost.
    #[error("GPU device: {0}")]
    Device(String),
    /// A texture, scene or film does not fit the device's limits.
    #[error("device limit: {0}")]
    Limit(String),
    /// A value the caller gave is out of its range.
    #[error("invalid argument: {0}")]
    Parameter(String),
    /// The file asks for what this version does not know.
    #[error("unsupported texture: {0}")]
    Unsupported(String),
    /// A file cannot be read.
    #[cfg(any(feature = "zstd", feature = "ruzstd"))]
    #[error(transparent)]
    File(#[from] vtex_format::ReadError),
    /// One of several files cannot be read.
    #[cfg(any(feature = "zstd", feature = "ruzstd"))]
    #[error("texture {index}, counted from 0: {source}")]
    FileOf {
        /// Which one, in the order in which they were given, from 0.
        index: usize,
        /// What is wrong with it.
        source: vtex_format::ReadError,
    },
    /// A shader or pipeline was refused: a defect of this crate or of a driver.
    #[error("shader: {0}")]
    Shader(String),
}
