//! The SVG files of a folder.

use std::path::Path;

use anyhow::{Context, Result};

/// Folder that is left out: its files are made to break readers.
const HOSTILE: &str = "hostile";

/// Paths below `root` of all its SVG files, sorted.
pub(crate) fn below(root: &Path) -> Result<Vec<String>> {
    let mut files = Vec::new();
    find(root, "", &mut files)?;
    files.sort();
    Ok(files)
}

/// Adds the files of `folder`, a path below `root`.
fn find(root: &Path, folder: &str, files: &mut Vec<String>) -> Result<()> {
    let path = root.join(folder);
    let entries = std::fs::read_dir(&path).with_context(|| path.display().to_string())?;
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let below = if folder.is_empty() {
            name.clone()
        } else {
            format!("{folder}/{name}")
        };
        let is_svg = name.rsplit_once('.').is_some_and(|(_, end)| {
            ["svg", "svgz"]
                .iter()
                .any(|known| end.eq_ignore_ascii_case(known))
        });
        if entry.path().is_dir() {
            if name != HOSTILE {
                find(root, &below, files)?;
            }
        } else if is_svg {
            files.push(below);
        }
    }
    Ok(())
}
