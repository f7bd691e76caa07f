//! What crates.io would get: every published crate is packed, and nothing is missing from it.

use anyhow::Result;

use crate::tidy::published;
use crate::workspace::{Member, Workspace};

/// Files that every package holds. The licences are links to the ones in the root; cargo packs what
/// they lead to.
const EVERYWHERE: [&str; 3] = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"];

/// Packs all published crates without building them, and prints what is missing. False when
/// something is.
pub(crate) fn run(ws: &Workspace) -> Result<bool> {
    let names = published(&ws.metadata()?);
    if !pack(ws, &names)? {
        return Ok(false);
    }
    let files = ws.files()?;
    let mut is_whole = true;
    for member in ws.members()? {
        if !names.contains(&member.name) {
            continue;
        }
        let listed = listing(ws, &member.name)?;
        for file in missing(&member, &files, &listed) {
            println!("{}: {file} is not in the package", member.name);
            is_whole = false;
        }
        println!("{}: {} files", member.name, listed.len());
    }
    Ok(is_whole)
}

/// Packs them together, so that each finds the others, which no registry has yet.
fn pack(ws: &Workspace, names: &[String]) -> Result<bool> {
    let mut arguments = vec!["package", "--no-verify", "--locked", "--allow-dirty"];
    for name in names {
        arguments.extend(["-p", name]);
    }
    // What cargo has to know of the dependencies came with them, unless nothing was built here yet.
    let mut offline = ws.cargo(&arguments);
    offline.arg("--offline").arg("--quiet");
    Ok(offline.status()?.success() || ws.cargo(&arguments).status()?.success())
}

/// Files that the package of this name holds.
fn listing(ws: &Workspace, name: &str) -> Result<Vec<String>> {
    let list = ["package", "--list", "--locked", "--allow-dirty", "-p", name];
    let listed = Workspace::output_of(ws.cargo(&list))?;
    // Cargo prints the separators of the machine it runs on.
    Ok(listed.lines().map(|line| line.replace('\\', "/")).collect())
}

/// Files that must be in the package and are not: [`EVERYWHERE`], and all that git tracks in its
/// folder, since each may be needed to build or to test it.
fn missing(member: &Member, files: &[String], listed: &[String]) -> Vec<String> {
    let folder = format!("{}/", member.folder);
    let tracked = files.iter().filter_map(|file| file.strip_prefix(&folder));
    let mut wanted: Vec<&str> = EVERYWHERE.into_iter().chain(tracked).collect();
    wanted.sort_unstable();
    wanted.dedup();
    wanted.retain(|&file| listed.iter().all(|listed| listed != file));
    wanted.into_iter().map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_tracked_and_what_all_hold_must_be_listed() {
        let member = Member {
            name: "a".to_owned(),
            folder: "a".to_owned(),
        };
        let owned = |files: &[&str]| files.iter().map(|file| (*file).to_owned()).collect();
        let files: Vec<String> = owned(&["a/README.md", "a/src/lib.rs", "ab/src/lib.rs"]);
        let listed: Vec<String> = owned(&["Cargo.toml.orig", "LICENSE-MIT", "README.md"]);
        assert_eq!(
            missing(&member, &files, &listed),
            ["LICENSE-APACHE", "src/lib.rs"]
        );
    }
}
