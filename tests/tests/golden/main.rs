//! Golden pictures: every drawing of `tests/data/svg`, baked and compared with a supersampled
//! truth, on the evaluator's Rust twin and on the GPU.
//!
//! A case is one drawing and one named test, `chapter::name`: `cargo test --test golden blend::`
//! runs a chapter. A chapter is a folder with a table `cases.tsv`, which has a row for every drawing
//! beside it; `tests/data/svg/README.md` says what its columns mean, and what the environment
//! variables `VTEX_PICTURES`, `VTEX_REPORT` and `VTEX_MARKS` do.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod eyes;
mod look;
mod lookups;
mod report;
mod table;
mod verdict;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use libtest_mimic::{Arguments, Failed, Trial};
use vtex_tests::gpu;

use crate::look::look;
use crate::report::Report;
use crate::table::Expected;
use crate::verdict::Verdict;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let report = Arc::new(Report::default());
    let mut trials: Vec<Trial> = chapters(&root())
        .iter()
        .flat_map(|folder| trials(folder, &report))
        .collect();
    trials.push(Trial::test("table::rows_are_read_strictly", || {
        table::rows_are_read_strictly();
        Ok(())
    }));
    let conclusion = libtest_mimic::run(&arguments, trials);
    report.finish(&root());
    conclusion.exit_code()
}

/// Where the chapters lie.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg")
}

/// Every folder with drawings: one without a table is a mistake that its trial reports.
fn chapters(root: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root).unwrap();
    let mut folders: Vec<PathBuf> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .collect();
    // Filters first: resvg takes minutes for one of them, and no thread is to wait for it at the end.
    folders.sort_by_key(|folder| (!folder.ends_with("filter"), folder.clone()));
    folders
}

/// A trial for each case of a chapter, and one for its table.
fn trials(folder: &Path, report: &Arc<Report>) -> Vec<Trial> {
    let chapter = folder.file_name().unwrap().to_string_lossy().into_owned();
    let table = table::read(folder);
    let problem = table.as_ref().err().cloned();
    let mut trials = vec![Trial::test(
        format!("{chapter}::{}", table::FILE),
        move || problem.map_or(Ok(()), |problem| Err(Failed::from(problem))),
    )];
    trials.extend(table.unwrap_or_default().into_iter().map(|expected| {
        let name = format!("{chapter}::{}", expected.name);
        let (folder, report) = (folder.to_owned(), Arc::clone(report));
        Trial::test(name, move || run(&expected, &folder, &report))
    }));
    trials
}

/// Runs a case.
fn run(expected: &Expected, folder: &Path, report: &Report) -> Result<(), Failed> {
    let chapter = folder.file_name().unwrap().to_string_lossy();
    let svg = std::fs::read(folder.join(format!("{}.svg", expected.name)))?;
    let untested = format!("{chapter}::{} on the GPU", expected.name);
    let gpu = vtex_testing::gpu(&untested).then(gpu::shared).flatten();
    let found = look(&svg, expected.fonts, gpu);
    let verdict = Verdict::new(&chapter, expected, found.as_ref().map_err(String::as_str));
    let failed = !verdict.surprises.is_empty();
    let message = verdict.surprises.join("; ");
    report.add(verdict);
    if let (true, Ok(found)) = (failed || report::all_pictures(), &found) {
        let pictures = report::pictures(&chapter);
        found.write(&pictures, &expected.name);
        if failed {
            return Err(format!("{message}\npictures: {}", pictures.display()).into());
        }
    }
    match failed {
        true => Err(message.into()),
        false => Ok(()),
    }
}
