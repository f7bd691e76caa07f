//! Files that the command reads and writes.

use std::path::Path;

pub(crate) mod input;
pub(crate) mod output;

/// The extension in lower case; empty when there is none.
pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .map_or_else(String::new, |ext| ext.to_string_lossy().to_lowercase())
}
