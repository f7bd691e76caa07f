//! What crates.io would get: every published crate is packed, and what must be in it is.

use anyhow::Result;

use crate::tidy::published;
use crate::workspace::Workspace;

/// Files that every package holds. The licences are links to the ones in the root, which cargo
/// follows.
const EVERYWHERE: [&str; 3] = ["LICENSE-APACHE", "LICENSE-MIT", "README.md"];
/// The package that the evaluator's modules are compiled into, and their folder.
const SHADERS: (&str, &str) = ("vtex-shaders", "wgsl/");

/// Packs all published crates without building them, and prints what is missing. False when
/// something is.
pub(crate) fn run(ws: &Workspace) -> Result<bool> {
    let names = published(&ws.metadata()?);
    let mut arguments = vec!["package", "--no-verify", "--locked", "--allow-dirty"];
    for name in &names {
        arguments.extend(["-p", name]);
    }
    // What is needed was fetched with the dependencies, unless nothing was built here yet.
    let mut offline = ws.cargo(&arguments);
    offline.arg("--offline").arg("--quiet");
    if !offline.status()?.success() && !ws.cargo(&arguments).status()?.success() {
        return Ok(false);
    }
    let mut is_whole = true;
    for name in &names {
        let listing = ["package", "--list", "--locked", "--allow-dirty", "-p", name];
        let listed = Workspace::output_of(ws.cargo(&listing))?;
        let listed: Vec<&str> = listed.lines().collect();
        for file in wanted(ws, name)? {
            if !listed.contains(&file.as_str()) {
                println!("{name}: {file} is not in the package");
                is_whole = false;
            }
        }
        println!("{name}: {} files", listed.len());
    }
    Ok(is_whole)
}

/// Files that the package of this name must hold, relative to it.
fn wanted(ws: &Workspace, name: &str) -> Result<Vec<String>> {
    let mut wanted: Vec<String> = EVERYWHERE.iter().map(|file| (*file).to_owned()).collect();
    if name == SHADERS.0 {
        let files = ws.files()?.into_iter();
        let inside = files.filter_map(|file| file.strip_prefix("shaders/").map(str::to_owned));
        wanted.extend(inside.filter(|file| file.starts_with(SHADERS.1)));
    }
    Ok(wanted)
}
