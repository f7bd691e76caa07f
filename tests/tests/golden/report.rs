//! What all cases came to: the worst, a table of figures, new marks.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use vtex_tests::parity::Parities;

use crate::table;
use crate::verdict::Verdict;

/// How many of the cases are printed.
const WORST: usize = 20;

/// Verdicts of the cases that ran, in any order.
#[derive(Debug, Default)]
pub(crate) struct Report {
    verdicts: Mutex<Vec<Verdict>>,
}

impl Report {
    pub(crate) fn add(&self, verdict: Verdict) {
        self.verdicts.lock().unwrap().push(verdict);
    }

    /// After all cases: prints the worst, and writes what the environment asks for.
    pub(crate) fn finish(&self, root: &Path) {
        let mut verdicts = self.verdicts.lock().unwrap();
        verdicts.sort_by(|a, b| a.margin_db.total_cmp(&b.margin_db));
        print_worst(&verdicts);
        if let Some(folder) = std::env::var_os("VTEX_REPORT") {
            std::fs::write(Path::new(&folder).join("golden.tsv"), figures(&verdicts)).unwrap();
        }
        if std::env::var_os("VTEX_MARKS").is_some_and(|value| value == "write") {
            write_marks(root, &verdicts);
        }
    }
}

/// Whether pictures of all cases are wanted, and not only of those that fail.
pub(crate) fn all_pictures() -> bool {
    std::env::var_os("VTEX_PICTURES").is_some_and(|value| value == "1")
}

/// Where pictures of a chapter are written.
pub(crate) fn pictures(chapter: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    folder.join("golden").join(chapter)
}

/// Nothing for a single case, whose failure says it all.
#[expect(clippy::print_stdout, reason = "the figures are wanted")]
fn print_worst(verdicts: &[Verdict]) {
    if verdicts.len() < 2 {
        return;
    }
    println!(
        "nearest to their bounds of {} cases, dB at 1x, 8x, mips:",
        verdicts.len()
    );
    for verdict in verdicts.iter().take(WORST) {
        println!("  {}", verdict.line());
    }
    let parities = verdicts.iter().map(|verdict| verdict.parities);
    let parities = parities.fold(Parities::default(), Parities::and);
    print!("GPU and twin, largest differences of all cases:\n{parities}");
}

fn figures(verdicts: &[Verdict]) -> String {
    let mut text = String::from("chapter\tcase\t1x\t8x\tmips\tfailed\n");
    for verdict in verdicts {
        let db = verdict.psnr_db.map(|db| format!("{db:.2}")).join("\t");
        let (chapter, name, failed) = (&verdict.chapter, &verdict.name, verdict.failed_names());
        // Writing to a String does not fail.
        let _ = writeln!(text, "{chapter}\t{name}\t{db}\t{failed}");
    }
    text
}

fn write_marks(root: &Path, verdicts: &[Verdict]) {
    let mut chapters: BTreeMap<&str, BTreeMap<&str, String>> = BTreeMap::new();
    for verdict in verdicts {
        let marks = chapters.entry(&verdict.chapter).or_default();
        marks.insert(&verdict.name, verdict.failed_names());
    }
    for (chapter, failed) in &chapters {
        table::write_marks(&root.join(chapter), failed);
    }
}
