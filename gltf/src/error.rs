//! Why an asset could not be read, and who must act.

/// Every error of this crate. What can be mended is a warning instead: see [`crate::Asset::warnings`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GltfError {
    /// The file breaks a rule of glTF, at the place that is named first.
    #[error("malformed glTF: {0}")]
    Malformed(String),
    /// The file is sound and asks for what this version does not know.
    #[error("unsupported glTF: {0}")]
    Unsupported(String),
    /// The file asks for more than [`crate::ReadOptions`] or the tracer allow.
    #[error("glTF limit: {0}")]
    Limit(String),
    /// A file that the asset needs cannot be read.
    #[error("glTF needs another file: {0}")]
    Missing(String),
    /// A value that the caller gave, such as the name of a variant, is not in the asset.
    #[error("invalid argument: {0}")]
    Parameter(String),
}

/// Result of reading.
pub(crate) type Outcome<T> = Result<T, GltfError>;

/// [`GltfError::Malformed`] at `place`.
pub(crate) fn malformed<T>(place: &str, what: impl std::fmt::Display) -> Outcome<T> {
    Err(GltfError::Malformed(format!("{place}: {what}")))
}

/// `list[index]`, or an error that says that `place` names what is not there.
pub(crate) fn find<'a, T>(list: &'a [T], index: usize, name: &str, place: &str) -> Outcome<&'a T> {
    list.get(index).ok_or_else(|| {
        GltfError::Malformed(format!(
            "{place}: there is no {name}[{index}], {name} has {} elements",
            list.len()
        ))
    })
}
