//! `cargo xtask tidy`: the rules that no compiler knows.

mod graph;
mod lints;
mod manifest;
mod specification;
mod text;
mod twins;

use anyhow::{Context, Result};

pub(crate) use manifest::published;

use crate::rooms;
use crate::workspace::Workspace;

/// Checks the whole workspace and prints what is wrong. False when something is.
pub(crate) fn run(ws: &Workspace) -> Result<bool> {
    let mut problems = Vec::new();
    let metadata = ws.metadata()?;
    let packages = graph::packages(&metadata)?;
    problems.extend(graph::check(&packages));
    problems.extend(manifest::check(&metadata));
    let workspace = ws.read("Cargo.toml")?.context("a manifest is not UTF-8")?;
    for package in packages.iter().filter(|package| package.is_member) {
        let manifest = ws
            .read(&package.manifest)?
            .context("a manifest is not UTF-8")?;
        problems.extend(lints::check_manifest(
            &package.manifest,
            &manifest,
            &workspace,
        ));
    }
    let files = ws.files()?;
    let mut texts = Vec::new();
    for file in &files {
        if let Some(content) = ws.read(file)? {
            problems.extend(text::check(file, &content));
            problems.extend(lints::check_source(file, &content));
            texts.push((file.clone(), content));
        }
    }
    problems.extend(twins::check(&texts));
    let read = |file| {
        ws.read(file)?
            .with_context(|| format!("{file} is not UTF-8"))
    };
    problems.extend(specification::check(
        &read(specification::ISSUES)?,
        &read(specification::DOCUMENT)?,
    ));
    problems.extend(rooms::problems(ws, &files)?);
    for problem in &problems {
        println!("{problem}");
    }
    println!("tidy: {} files, {} problems", files.len(), problems.len());
    Ok(problems.is_empty())
}
