//! Why a bake failed and who must act.

/// Why an SVG could not be baked. The text is one line for people.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The input is not an SVG that can be read.
    #[error("not a usable SVG: {0}")]
    Svg(String),
    /// An option is out of its range.
    #[error("option out of range: {0}")]
    Parameter(String),
    /// A budget would be exceeded.
    #[error("limit exceeded: {0}")]
    Limit(String),
    /// The shader of the file could not be made: a fault of this program.
    #[error("shader of the file: {0}")]
    Shader(String),
}
