//! Who is at fault, where, and what to do.

/// Why bytes could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file is broken: bake it again or fetch it again.
    #[error("malformed .vtex file: {0}")]
    Malformed(String),
}

/// Why a value could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The value breaks a rule of the format.
    #[error("cannot write .vtex: {0}")]
    Invalid(String),
}
