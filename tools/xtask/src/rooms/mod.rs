//! Rooms: which file imports which, and whether the folders stay small and import in one direction.
//!
//! **File.** A `.rs` file below `src/` that a crate root reaches by `mod`. Modules under
//! `#[cfg(test)]` are left out with everything below them: tests may import anything.
//!
//! **Arrow.** File A imports file B when code in A names something that B defines. Names are
//! followed through `use`, `as`, globs and re-exports to the file that holds the definition. A
//! re-export and a `mod` declaration are no arrows of their own, so a `mod.rs` that only declares
//! and re-exports imports nothing. Calls of methods are not seen: a method has no path.
//!
//! **Room.** The folder that holds a file. A module's own file belongs to the folder of its
//! children: `cells/mod.rs`, or `cells.rs` beside a folder `cells/`, is in the room `cells`.
//!
//! **Circle.** Files of one room may import each other. Between rooms arrows point one way, and
//! that is checked in each folder on its own: the folder's sub-folders (each with all that lies
//! below it) and its own files are nodes, and a circle that touches a sub-folder is a problem. So
//! two rooms that import each other are found even when no two of their files do, and a room that
//! imports what the `mod.rs` above it defines is found when that `mod.rs` imports the room.
//!
//! **Size.** A folder holds at most 12 source files (`.rs` or `.wgsl`), tests included. Folders
//! named `data` are no rooms.

mod arrows;
mod check;
mod exemptions;
mod knots;
mod resolve;
mod size;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod tree;

use std::collections::BTreeMap;

use anyhow::{Context, Result};

use crate::workspace::Workspace;
use arrows::Arrows;
use exemptions::EXEMPTIONS;
use tree::Tree;

/// A member of the workspace with its Rust sources and what they import.
struct Crate {
    /// Its folder in the workspace, as `tools/vtex`.
    folder: String,
    /// Text of every `.rs` file below `src/` by its path in the workspace.
    sources: BTreeMap<String, String>,
    arrows: Arrows,
}

impl Crate {
    fn new(name: &str, folder: &str, sources: BTreeMap<String, String>) -> Result<Self> {
        let tree = Tree::load(name, folder, &sources)?;
        Ok(Self {
            folder: folder.to_owned(),
            arrows: Arrows::of(&tree),
            sources,
        })
    }

    fn all(ws: &Workspace, files: &[String]) -> Result<Vec<Self>> {
        let mut crates = Vec::new();
        for member in ws.members()? {
            let source = format!("{}/src/", member.folder);
            let mut sources = BTreeMap::new();
            for file in files.iter().filter(|file| file.starts_with(&source)) {
                if file.ends_with(".rs") {
                    let text = ws.read(file)?.context("a source file is not UTF-8")?;
                    sources.insert(file.clone(), text);
                }
            }
            crates.push(Self::new(&member.name, &member.folder, sources)?);
        }
        Ok(crates)
    }
}

/// What `cargo xtask tidy` reports: circles between rooms, folders with too many files, and
/// exemptions that are no longer needed.
pub(crate) fn problems(ws: &Workspace, files: &[String]) -> Result<Vec<String>> {
    let crates = Crate::all(ws, files)?;
    let findings = crates
        .iter()
        .flat_map(|one| check::circles(&one.arrows))
        .chain(size::findings(files))
        .collect();
    Ok(exemptions::apply(EXEMPTIONS, findings))
}

/// Entry of `cargo xtask rooms`: prints the figures of each crate and each room.
pub(crate) fn run(ws: &Workspace) -> Result<bool> {
    let files = ws.files()?;
    print!("{}", table::text(&Crate::all(ws, &files)?, &files));
    Ok(true)
}
