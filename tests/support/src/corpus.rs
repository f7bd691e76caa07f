//! The corpus: real SVG files to test on, which are not part of the project.
//!
//! Its folder is the one that `VTEX_CORPUS` names, else `../shared/corpus` beside the workspace;
//! `VTEX_CORPUS=off` says that there is none.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::skip;

/// Drawings made to hang, abort or exhaust memory; only tests that want them name this folder.
const HOSTILE: &str = "hostile";

/// A corpus that exists.
#[derive(Clone, Debug)]
pub struct Corpus {
    root: PathBuf,
}

/// What the environment says about the corpus.
#[derive(Debug, PartialEq, Eq)]
enum Found {
    /// Here it is.
    Folder(PathBuf),
    /// Not wanted, or not there and nobody minds: the reason.
    Absent(String),
    /// Missing where it must not be: the reason.
    Missing(String),
}

/// Folder of the corpus for tools that can do without it; `None` where it is absent or off.
///
/// # Errors
/// The reason, when `VTEX_CORPUS` names a folder that does not exist, or `CI` is set and there is
/// no corpus.
pub fn folder() -> Result<Option<PathBuf>, String> {
    match find() {
        Found::Folder(root) => Ok(Some(root)),
        Found::Absent(_) => Ok(None),
        Found::Missing(why) => Err(why),
    }
}

fn find() -> Found {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus");
    let is_ci = std::env::var_os("CI").is_some_and(|value| !value.is_empty());
    decide(std::env::var_os("VTEX_CORPUS"), beside, is_ci)
}

fn decide(named: Option<OsString>, beside: PathBuf, is_ci: bool) -> Found {
    match named {
        Some(value) if value == "off" => Found::Absent("VTEX_CORPUS=off".to_owned()),
        Some(value) if Path::new(&value).is_dir() => Found::Folder(value.into()),
        Some(value) => Found::Missing(format!("VTEX_CORPUS names {value:?}, which is no folder")),
        None if beside.is_dir() => Found::Folder(beside),
        None if is_ci => Found::Missing(format!(
            "no corpus at {}, and CI is set: name one with VTEX_CORPUS, or leave its tests out \
             with VTEX_CORPUS=off",
            beside.display()
        )),
        None => Found::Absent(format!("no corpus at {}", beside.display())),
    }
}

impl Corpus {
    /// The corpus, or `None` where it may be missing; then stderr says that a test left `untested`
    /// out.
    ///
    /// # Panics
    /// When `VTEX_CORPUS` names a folder that does not exist, and where there is no corpus although
    /// `CI` is set: only `VTEX_CORPUS=off` leaves these tests out there.
    #[track_caller]
    pub fn find(untested: &str) -> Option<Self> {
        match find() {
            Found::Folder(root) => Some(Self { root }),
            Found::Absent(why) => {
                skip(&why, untested);
                None
            }
            Found::Missing(why) => panic!("{why}"),
        }
    }

    /// Path of a file or folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// A file's bytes, by its path in the corpus.
    ///
    /// # Panics
    /// When it cannot be read: a corpus without it is not the one that the test wants.
    pub fn read(&self, name: &str) -> Vec<u8> {
        let path = self.path(name);
        std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// SVG files of some folders and of the folders inside them, sorted.
    ///
    /// # Panics
    /// When a folder has none.
    pub fn svg_files(&self, folders: &[&str]) -> Vec<PathBuf> {
        let list = |folder: &&str| {
            let files = svg_files(&self.path(folder));
            assert!(!files.is_empty(), "no SVG file in {:?}", self.path(folder));
            files
        };
        let mut files: Vec<PathBuf> = folders.iter().flat_map(list).collect();
        files.sort();
        files
    }

    /// All SVG files but the hostile ones, sorted.
    ///
    /// # Panics
    /// When there is none.
    pub fn drawings(&self) -> Vec<PathBuf> {
        let mut files = svg_files(&self.root);
        let hostile = self.path(HOSTILE);
        files.retain(|path| !path.starts_with(&hostile));
        assert!(!files.is_empty(), "no SVG file in {:?}", self.root);
        files
    }

    /// A file's path without the corpus's, for messages.
    pub fn name(&self, path: &Path) -> String {
        let inside = path.strip_prefix(&self.root).unwrap_or(path);
        inside.display().to_string()
    }
}

/// Files that end in `.svg` or `.svgz` in a folder and the folders inside it, sorted.
///
/// # Panics
/// When a folder cannot be listed.
pub fn svg_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder);
        let entries = entries.unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for entry in entries {
            let path = entry.expect("a folder's entry").path();
            let ends = |ending| path.extension().is_some_and(|found| found == ending);
            if path.is_dir() {
                folders.push(path);
            } else if ends("svg") || ends("svgz") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_corpus_fails_where_it_must() {
        let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let nowhere = here.join("no such folder");
        let named = |path: &Path| Some(path.as_os_str().to_owned());
        let decide = |named, beside: &PathBuf, is_ci| decide(named, beside.clone(), is_ci);
        let missing = |found| matches!(found, Found::Missing(_));
        let absent = |found| matches!(found, Found::Absent(_));
        for is_ci in [false, true] {
            assert_eq!(decide(None, &here, is_ci), Found::Folder(here.clone()));
            assert_eq!(
                decide(named(&here), &nowhere, is_ci),
                Found::Folder(here.clone())
            );
            assert!(
                missing(decide(named(&nowhere), &here, is_ci)),
                "named in vain"
            );
            assert!(absent(decide(named(Path::new("off")), &here, is_ci)), "off");
        }
        assert!(absent(decide(None, &nowhere, false)), "at home");
        assert!(missing(decide(None, &nowhere, true)), "in CI");
    }
}
