//! Files that the command reads and writes.

use std::path::Path;

pub(crate) mod input;
pub(crate) mod output;

/// A path as text for JSON, which takes UTF-8 alone: other bytes become U+FFFD.
pub(crate) fn lossy(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// The extension in lower case; empty when there is none.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .map_or_else(String::new, |ext| ext.to_string_lossy().to_lowercase())
}
