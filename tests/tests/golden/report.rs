//! All cases of a folder.

#![expect(clippy::print_stdout, reason = "the worst are wanted")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::look::look;
use crate::table::{self, Expected};
use crate::verdict::Verdict;

/// How many of a chapter's cases are printed.
const WORST: usize = 5;

/// Runs a chapter.
///
/// # Panics
/// When a case does what its line in the table does not say.
pub(crate) fn run(chapter: &str) {
    let folder = crate::root().join(chapter);
    let wanted = std::env::var("VTEX_FILTER").unwrap_or_default();
    let mut cases = table::read(&folder);
    cases.retain(|case| format!("{chapter}/{}", case.name).contains(&wanted));
    let mut verdicts: Vec<Verdict> = cases
        .par_iter()
        .map(|case| judge(case, chapter, &folder))
        .collect();
    verdicts.sort_by(|a, b| a.margin_db.total_cmp(&b.margin_db));
    print_worst(chapter, &verdicts);
    report(chapter, &verdicts);
    if std::env::var_os("VTEX_MARKS").is_some_and(|value| value == "write") {
        let marks = verdicts
            .iter()
            .map(|verdict| (verdict.name.as_str(), verdict.failed_names()));
        table::write_marks(&folder, &marks.collect());
        return;
    }
    let wrong: Vec<String> = verdicts
        .iter()
        .filter(|verdict| !verdict.surprises.is_empty())
        .map(|verdict| {
            format!(
                "{chapter}/{}: {}",
                verdict.name,
                verdict.surprises.join("; ")
            )
        })
        .collect();
    assert!(
        wrong.is_empty(),
        "{} of {} cases are not as {} says:\n{}\npictures: {}",
        wrong.len(),
        verdicts.len(),
        table::FILE,
        wrong.join("\n"),
        pictures(chapter).display()
    );
}

fn judge(case: &Expected, chapter: &str, folder: &Path) -> Verdict {
    let svg = std::fs::read(folder.join(format!("{}.svg", case.name))).unwrap();
    let found = look(&svg);
    let verdict = Verdict::new(case, found.as_ref().map_err(String::as_str));
    let all = std::env::var_os("VTEX_PICTURES").is_some_and(|value| value == "1");
    if let (true, Ok(found)) = (all || !verdict.surprises.is_empty(), &found) {
        for view in &found.views {
            view.write(&pictures(chapter), &case.name);
        }
    }
    verdict
}

/// Where pictures of a chapter are written.
fn pictures(chapter: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("cases")
        .join(chapter)
}

fn print_worst(chapter: &str, verdicts: &[Verdict]) {
    let mut text = format!("{chapter}: {} cases, the worst\n", verdicts.len());
    for verdict in verdicts.iter().take(WORST) {
        // Writing to a String does not fail.
        let _ = writeln!(text, "  {}", verdict.line());
    }
    print!("{text}");
}

/// Every figure, in the folder that `VTEX_REPORT` names.
fn report(chapter: &str, verdicts: &[Verdict]) {
    let Some(folder) = std::env::var_os("VTEX_REPORT") else {
        return;
    };
    let mut text = String::from("case\t1x\t8x\tfailed\n");
    for verdict in verdicts {
        let db: Vec<String> = verdict
            .psnr_db
            .iter()
            .map(|db| format!("{db:.2}"))
            .collect();
        let _ = writeln!(
            text,
            "{}\t{}\t{}",
            verdict.name,
            db.join("\t"),
            verdict.failed_names()
        );
    }
    std::fs::write(
        Path::new(&folder).join(format!("cases-{chapter}.tsv")),
        text,
    )
    .unwrap();
}
