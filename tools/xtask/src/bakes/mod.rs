//! `cargo xtask bakes`: what two builds of `vtex` bake differently.

mod difference;
mod table;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, bail, ensure};

use crate::drawings;
use difference::{Comparison, Totals};

/// How the tool is called.
pub(crate) const USAGE: &str = "\
usage: cargo xtask bakes OLD NEW DIR [--jobs N]

Bakes every .svg and .svgz below DIR (but not below a folder `hostile`) with two vtex binaries and
compares the raw bytes of each section by their hashes. A file that both refuse with the same exit
code counts as the same. Exits with 7 when more differs than SPEC, SHDR and the baker's version in
PROV.

  --jobs N   files at a time; default: one a core";

/// Options of every bake. The limits are far off, so that a busy machine refuses nothing.
const BAKE: [&str; 9] = [
    "--threads",
    "1",
    "bake",
    "--quiet",
    "--no-system-fonts",
    "--timeout",
    "900",
    "--max-memory",
    "8192",
];
/// Exit code of `vtex` for a command line that it does not understand.
const USAGE_ERROR: i32 = 1;
/// A line of progress comes after so many files.
const PROGRESS_FILES: usize = 10;
/// What `vtex info --format json` says of PROV besides the baker's version.
const PROVENANCE: [&str; 5] = ["source_hash", "options", "shapes", "warnings", "patches"];

#[derive(Debug, PartialEq, Eq)]
struct Options {
    old: PathBuf,
    new: PathBuf,
    folder: PathBuf,
    jobs: usize,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self> {
        let mut jobs = std::thread::available_parallelism().map_or(1, usize::from);
        let mut paths = Vec::new();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            match argument.as_str() {
                "--jobs" => jobs = rest.next().context("--jobs needs a value")?.parse()?,
                name if name.starts_with("--") => bail!("no option {name}"),
                path => paths.push(PathBuf::from(path)),
            }
        }
        ensure!(jobs > 0, "--jobs wants at least 1");
        let [old, new, folder] = <[PathBuf; 3]>::try_from(paths)
            .ok()
            .context("two binaries and a folder")?;
        Ok(Self {
            old,
            new,
            folder,
            jobs,
        })
    }
}

/// Compares as asked for. False when more differs than may.
pub(crate) fn run(arguments: &[String]) -> Result<bool> {
    let mut options = Options::parse(arguments).map_err(|error| error.context(USAGE))?;
    for vtex in [&mut options.old, &mut options.new] {
        *vtex = vtex
            .canonicalize()
            .with_context(|| vtex.display().to_string())?;
    }
    let files = drawings::below(&options.folder)?;
    ensure!(!files.is_empty(), "no SVG in {}", options.folder.display());
    let scratch = std::env::temp_dir().join(format!("vtex-bakes-{}", std::process::id()));
    std::fs::create_dir_all(&scratch).with_context(|| scratch.display().to_string())?;
    let compared = compare_all(&options, &files, &scratch);
    std::fs::remove_dir_all(&scratch)?;
    let compared = compared?;
    let mut totals = Totals::default();
    for comparison in &compared {
        totals.add(comparison);
    }
    println!("{}", totals.text());
    ensure!(!totals.is_empty(), "no file was baked by both");
    Ok(compared.iter().all(Comparison::is_allowed))
}

/// Compares every file, some at a time, and says at once what differs.
fn compare_all(options: &Options, files: &[String], scratch: &Path) -> Result<Vec<Comparison>> {
    let next = AtomicUsize::new(0);
    let compared = Mutex::new(Vec::new());
    let work = || -> Result<()> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(file) = files.get(index) else {
                return Ok(());
            };
            let outputs = ["old", "new"].map(|name| scratch.join(format!("{index}-{name}.vtex")));
            let comparison = compare(options, file, &outputs).with_context(|| file.clone())?;
            for output in outputs.iter().filter(|output| output.exists()) {
                std::fs::remove_file(output)?;
            }
            if let Some(text) = comparison.text() {
                println!("{file}: {text}");
            }
            if let Ok(mut compared) = compared.lock() {
                compared.push(comparison);
                let (done, all) = (compared.len(), files.len());
                if done.is_multiple_of(PROGRESS_FILES) || done == all {
                    eprintln!("{done}/{all} files");
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..options.jobs).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| {
            worker
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    })?;
    Ok(compared.into_inner().unwrap_or_default())
}

fn compare(options: &Options, file: &str, outputs: &[PathBuf; 2]) -> Result<Comparison> {
    let svg = options.folder.join(file);
    let old = bake(&options.old, &svg, &outputs[0])?;
    let new = bake(&options.new, &svg, &outputs[1])?;
    match (old, new) {
        (Some(0), Some(0)) => {}
        (Some(USAGE_ERROR), _) | (_, Some(USAGE_ERROR)) => bail!("vtex did not take its options"),
        (Some(old), Some(new)) if old == new => return Ok(Comparison::Refused(old)),
        (old, new) => {
            let [old, new] = [old, new].map(exit_text);
            return Ok(Comparison::Broken(format!("{old}, now {new}")));
        }
    }
    let read = |path: &PathBuf| table::sections(&std::fs::read(path)?);
    let mut comparison = Comparison::new(&read(&outputs[0])?, &read(&outputs[1])?);
    if comparison.has("PROV") {
        let keys = differing_info(&info(options, &outputs[0])?, &info(options, &outputs[1])?);
        if !keys.is_empty() {
            comparison.add("PROV beyond its version", &keys.join(", "));
        }
    }
    Ok(comparison)
}

/// Bakes and returns the exit code, `None` when a signal ended the process.
fn bake(vtex: &Path, svg: &Path, output: &Path) -> Result<Option<i32>> {
    let mut command = Command::new(vtex);
    command
        .args(BAKE)
        .arg(svg)
        .arg("--output")
        .arg(output)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let status = command
        .status()
        .with_context(|| format!("cannot run {}", vtex.display()))?;
    Ok(status.code())
}

fn exit_text(code: Option<i32>) -> String {
    code.map_or_else(|| "a crash".to_owned(), |code| format!("exit code {code}"))
}

/// What the new binary says about a file: one reader for both, so that only files differ.
fn info(options: &Options, file: &Path) -> Result<serde_json::Value> {
    let mut command = Command::new(&options.new);
    command.args(["info", "--format", "json"]).arg(file);
    let output = command.output()?;
    ensure!(output.status.success(), "vtex info cannot read its bake");
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// Parts of the provenance that differ, without the version.
fn differing_info(old: &serde_json::Value, new: &serde_json::Value) -> Vec<&'static str> {
    let mut parts = PROVENANCE.to_vec();
    parts.retain(|part| old.get(part) != new.get(part));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn two_binaries_and_a_folder_are_wanted() {
        let parse = |line: &str| {
            let arguments: Vec<String> = line.split(' ').map(str::to_owned).collect();
            Options::parse(&arguments)
        };
        let options = parse("old new --jobs 3 art").unwrap();
        assert_eq!((options.folder, options.jobs), (PathBuf::from("art"), 3));
        for line in [
            "old new",
            "old new art more",
            "old new art --jobs 0",
            "a b c --x",
        ] {
            assert!(parse(line).is_err(), "{line}");
        }
    }

    #[test]
    fn the_version_in_the_provenance_may_differ() {
        let old = json!({"tool": "vtex 1", "warnings": [], "paints": 3});
        let new = json!({"tool": "vtex 2", "warnings": ["text"], "paints": 3});
        assert_eq!(differing_info(&old, &new), ["warnings"]);
        assert!(differing_info(&old, &old).is_empty());
    }
}
