//! The graph of imports between files.

use std::collections::{BTreeMap, BTreeSet};

use super::resolve::{Target, resolve};
use super::tree::{Tree, parent_folder};

/// Files and who imports whom; indices are those of `files`.
#[derive(Debug, Default)]
pub(super) struct Arrows {
    pub(super) files: Vec<String>,
    /// `(importing, imported)`, with the first line that does it.
    pub(super) lines: BTreeMap<(usize, usize), usize>,
}

impl Arrows {
    pub(super) fn of(tree: &Tree) -> Self {
        let mut lines = BTreeMap::new();
        for (index, module) in tree.modules.iter().enumerate() {
            let uses = module.scope.uses.iter().filter(|one| !one.is_public);
            let named = uses.map(|one| (&one.path, one.line));
            let mentioned = module
                .scope
                .mentions
                .iter()
                .map(|one| (&one.path, one.line));
            for (path, line) in named.chain(mentioned) {
                // A module that is named only brings its name into scope.
                if let Target::File(file) = resolve(tree, index, path)
                    && file != module.file
                {
                    let first = lines.entry((module.file, file)).or_insert(line);
                    *first = line.min(*first);
                }
            }
        }
        Self {
            files: tree.files.clone(),
            lines,
        }
    }

    pub(super) fn edges(&self) -> BTreeSet<(usize, usize)> {
        self.lines.keys().copied().collect()
    }

    /// `a.rs:12 imports b.rs`.
    pub(super) fn describe(&self, (from, to): (usize, usize)) -> String {
        let line = self.lines[&(from, to)];
        format!("{}:{line} imports {}", self.files[from], self.files[to])
    }

    /// The room of each file: its folder, or the folder of its children where it has some.
    pub(super) fn rooms(&self) -> Vec<&str> {
        let folders: BTreeSet<&str> = self.files.iter().map(|file| parent_folder(file)).collect();
        let room = |file: &'_ String| {
            let own = file.trim_end_matches(".rs");
            folders.get(own).copied()
        };
        let files = self.files.iter();
        files
            .map(|file| room(file).unwrap_or_else(|| parent_folder(file)))
            .collect()
    }
}
