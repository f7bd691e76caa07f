//! The modules of a crate, each with its file.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};

use super::source::{self, Child, Scope};

/// All modules below the roots of a package: its library, its program, those in `bin/`.
#[derive(Debug, Default)]
pub(super) struct Tree {
    /// Paths in the workspace.
    pub(super) files: Vec<String>,
    pub(super) modules: Vec<Module>,
    /// The library as other roots call it, with its module.
    pub(super) library: Option<(String, usize)>,
}

/// A module; indices are those of the tree.
#[derive(Debug)]
pub(super) struct Module {
    pub(super) root: usize,
    pub(super) parent: Option<usize>,
    pub(super) file: usize,
    pub(super) scope: Scope,
    pub(super) children: BTreeMap<String, usize>,
}

/// Where a module stands and where the files of its children lie.
#[derive(Clone, Copy)]
struct Place<'a> {
    parent: Option<usize>,
    file: &'a str,
    folder: &'a str,
}

impl Tree {
    /// Reads the package in `folder`. `sources` holds the text of every file by its path.
    pub(super) fn load(
        package: &str,
        folder: &str,
        sources: &BTreeMap<String, String>,
    ) -> Result<Self> {
        let mut tree = Self::default();
        let source = format!("{folder}/src");
        let [library, program] = ["lib", "main"].map(|name| format!("{source}/{name}.rs"));
        let programs = format!("{source}/bin/");
        let is_root =
            |file: &&String| **file == library || **file == program || file.starts_with(&programs);
        for file in sources.keys().filter(is_root) {
            let folder = parent_folder(file);
            let root = tree.add_file(file, folder, None, sources)?;
            if *file == library {
                tree.library = Some((package.replace('-', "_"), root));
            }
        }
        Ok(tree)
    }

    fn add_file(
        &mut self,
        file: &str,
        folder: &str,
        parent: Option<usize>,
        sources: &BTreeMap<String, String>,
    ) -> Result<usize> {
        let text = sources
            .get(file)
            .with_context(|| format!("no file {file}"))?;
        let scope = source::parse(text).with_context(|| file.to_owned())?;
        let place = Place {
            parent,
            file,
            folder,
        };
        self.add(scope, place, sources)
    }

    fn add(
        &mut self,
        mut scope: Scope,
        place: Place<'_>,
        sources: &BTreeMap<String, String>,
    ) -> Result<usize> {
        let known = self.files.iter().position(|file| file == place.file);
        let file = known.unwrap_or_else(|| {
            self.files.push(place.file.to_owned());
            self.files.len() - 1
        });
        let index = self.modules.len();
        let children = std::mem::take(&mut scope.children);
        self.modules.push(Module {
            root: place
                .parent
                .map_or(index, |parent| self.modules[parent].root),
            parent: place.parent,
            file,
            scope,
            children: BTreeMap::new(),
        });
        for child in children {
            let name = child.name.clone();
            let folder = format!("{}/{name}", place.folder);
            let below = Place {
                parent: Some(index),
                ..place
            };
            let child = match child.body {
                Some(body) => {
                    let folder = &folder;
                    self.add(body, Place { folder, ..below }, sources)?
                }
                None => {
                    let file = child_file(&child, below, sources)?;
                    let folder = match file.strip_suffix("/mod.rs") {
                        Some(folder) => folder,
                        None => file.trim_end_matches(".rs"),
                    };
                    self.add_file(&file, folder, below.parent, sources)?
                }
            };
            self.modules[index].children.insert(name, child);
        }
        Ok(index)
    }
}

/// The file of `mod name;`.
fn child_file(
    child: &Child,
    place: Place<'_>,
    sources: &BTreeMap<String, String>,
) -> Result<String> {
    if let Some(path) = &child.path {
        return Ok(format!("{}/{path}", parent_folder(place.file)));
    }
    let name = &child.name;
    let places = [format!("{name}.rs"), format!("{name}/mod.rs")];
    let mut places = places
        .map(|file| format!("{}/{file}", place.folder))
        .into_iter();
    match places.find(|file| sources.contains_key(file)) {
        Some(file) => Ok(file),
        None => bail!("{}:{}: mod {name} has no file", place.file, child.line),
    }
}

/// The folder that holds a file.
pub(super) fn parent_folder(file: &str) -> &str {
    file.rsplit_once('/').map_or("", |(folder, _)| folder)
}
