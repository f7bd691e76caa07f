//! Why a bake failed and who must act.

/// Why an SVG could not be baked. Its text is one line for people.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The input is not a readable SVG: the file is at fault.
    #[error("not a usable SVG: {0}")]
    Svg(String),
    /// An option is out of its range: the caller is at fault.
    #[error("option out of range: {0}")]
    Parameter(String),
    /// The drawing asks for more than a limit allows.
    #[error("limit exceeded: {0}")]
    Limit(String),
    /// The shader of the file could not be made: this crate is at fault.
    #[error("shader of the file: {0}")]
    Shader(String),
}
