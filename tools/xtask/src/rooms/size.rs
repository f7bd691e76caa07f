//! How many source files a folder holds.

use std::collections::BTreeMap;

use super::exemptions::{Finding, Rule};
use super::tree::parent_folder;

/// Source files in one folder: past it a reader searches instead of looking.
pub(super) const MAX_FILES: usize = 12;

/// Source files by folder, data aside.
pub(super) fn folders(files: &[String]) -> BTreeMap<&str, usize> {
    let mut counts = BTreeMap::new();
    for file in files {
        let folder = parent_folder(file);
        let is_data = folder.split('/').any(|part| part == "data");
        if (file.ends_with(".rs") || file.ends_with(".wgsl")) && !is_data {
            *counts.entry(folder).or_insert(0) += 1;
        }
    }
    counts
}

/// One finding for each folder with too many.
pub(super) fn findings(files: &[String]) -> Vec<Finding> {
    let crowded = folders(files)
        .into_iter()
        .filter(|(_, count)| *count > MAX_FILES);
    crowded
        .map(|(folder, count)| Finding {
            rule: Rule::Size,
            room: folder.to_owned(),
            text: format!("{folder}: {count} source files in one folder, {MAX_FILES} at most"),
        })
        .collect()
}
