//! `cargo xtask corpus`: every SVG of a folder baked and measured, as a table.

mod bars;
mod child;
mod csv;
mod measure;
mod options;
mod page;
mod row;
mod totals;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, ensure};
use indicatif::{ProgressBar, ProgressStyle};

use crate::drawings;
use crate::workspace::Workspace;
use measure::Bench;
use options::Options;
use row::Row;
use totals::{FeatureTotals, Totals, Verdict};

pub(crate) use options::USAGE;

/// The table for programs.
const CSV: &str = "corpus.csv";

/// Measures as asked for and writes both tables. False when a file failed or too many missed a bar.
pub(crate) fn run(ws: &Workspace, arguments: &[String]) -> Result<bool> {
    let options = Options::parse(arguments).map_err(|error| error.context(USAGE))?;
    let mut files = drawings::below(&options.folder)?;
    files.retain(|file| file.contains(&options.filter));
    ensure!(
        !files.is_empty(),
        "no SVG to measure in {}",
        options.folder.display()
    );
    let vtex = match &options.vtex {
        Some(vtex) => vtex.clone(),
        None => build(ws)?,
    };
    let scratch = options.out.join("scratch");
    std::fs::create_dir_all(&scratch).with_context(|| scratch.display().to_string())?;
    let bench = Bench {
        vtex: &vtex,
        options: &options,
        scratch: &scratch,
    };
    let rows = measure_all(&bench, &files)?;
    std::fs::remove_dir_all(&scratch)?;
    let [csv, html] = [CSV, "corpus.html"].map(|name| options.out.join(name));
    std::fs::write(&csv, csv::write(rows.iter(), &options))?;
    std::fs::write(&html, page::write(&rows, &options))?;
    Ok(report(&rows, &options, &html))
}

/// Measures every file; rows come worst first.
fn measure_all(bench: &Bench<'_>, files: &[String]) -> Result<Vec<Row>> {
    let options = bench.options;
    let progress = ProgressBar::new(files.len() as u64);
    if let Ok(style) =
        ProgressStyle::with_template("[{bar:40}] {pos}/{len} {elapsed} eta {eta} {msg}")
    {
        progress.set_style(style);
    }
    let table = options.out.join(CSV);
    let next = AtomicUsize::new(0);
    let rows: Mutex<Vec<(usize, Row)>> = Mutex::default();
    let work = || -> Result<()> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(file) = files.get(index) else {
                return Ok(());
            };
            let row = bench.measure(file, index)?;
            progress.set_message(file.clone());
            progress.inc(1);
            if let Ok(mut rows) = rows.lock() {
                rows.push((index, row));
                // What is there stays when a long run is broken off.
                std::fs::write(&table, csv::write(rows.iter().map(|(_, row)| row), options))?;
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
    progress.finish_and_clear();
    let mut rows = rows.into_inner().unwrap_or_default();
    let rank = |row: &Row| row.rank(&options.bars);
    rows.sort_by(|(_, a), (_, b)| {
        let order = rank(a).total_cmp(&rank(b));
        order.then_with(|| a.file.cmp(&b.file))
    });
    for (index, row) in rows.iter_mut().take(options.pictures) {
        if let Some((zoom, _)) = row.margin(&options.bars) {
            bench.add_pictures(row, *index, options.zooms[zoom])?;
        }
    }
    Ok(rows.into_iter().map(|(_, row)| row).collect())
}

/// Says in a few lines what came out; false when files failed or too many missed a bar.
fn report(rows: &[Row], options: &Options, html: &Path) -> bool {
    let bars = &options.bars;
    let missed: Vec<&Row> = rows.iter().filter(|row| row.misses(bars)).collect();
    for row in &missed {
        println!("{}", missed_text(row, options));
    }
    let all = Totals::by_folder(rows, options.zooms.len(), bars).pop();
    let (_, all) = all.unwrap_or_default();
    let percent = |part: usize| 100.0 * part as f64 / all.files.max(1) as f64;
    println!(
        "{} files, {} ({:.1}%) without raster patches, {} compared, {} failed, {} failed or below a bar",
        all.files,
        all.native,
        percent(all.native),
        all.compared,
        all.failed,
        all.missed
    );
    let area = 100.0 * all.mean_patch_area();
    println!("patches cover {area:.2}% of the pixels");
    for (feature, totals) in FeatureTotals::all(rows) {
        let (files, alone, area) = (totals.files, totals.alone, 100.0 * totals.mean_area());
        println!("  {feature}: in {files} files, alone in {alone}, {area:.1}% of their pixels");
    }
    for (index, zoom) in options.zooms.iter().enumerate() {
        if let Some([least, median]) = all.least_and_median(index) {
            println!("{zoom:>5}x: least {least:.1} dB, median {median:.1} dB");
        }
    }
    let verdicts = Verdict::all(rows, options.zooms.len(), bars);
    for verdict in &verdicts {
        println!("{}", verdict_text(verdict, options));
    }
    println!("{}", html.display());
    all.failed == 0 && verdicts.iter().all(Verdict::holds)
}

/// `icons/a.svg: 38.1 44.0, wants 40 38 (mask)`.
fn missed_text(row: &Row, options: &Options) -> String {
    if let Some(error) = &row.error {
        return format!("{}: {error}", row.file);
    }
    let db = |db: Option<f64>| db.map_or_else(|| "-".to_owned(), |db| format!("{db:.1}"));
    let zooms = 0..row.zooms.len();
    let found: Vec<String> = zooms
        .clone()
        .map(|z| db(Some(row.zooms[z].psnr_db)))
        .collect();
    let wanted: Vec<String> = zooms.map(|z| db(row.bar_db(&options.bars, z))).collect();
    let warnings = row.content.warning_text();
    let [found, wanted] = [found, wanted].map(|all| all.join(" "));
    format!("{}: {found} dB, wants {wanted} ({warnings})", row.file)
}

fn verdict_text(verdict: &Verdict, options: &Options) -> String {
    let kind = if verdict.native { "without" } else { "with" };
    let [share, wanted] = [verdict.share(), verdict.bar.share].map(|share| 100.0 * share);
    let (reached, files, db) = (verdict.reached, verdict.files, verdict.bar.db);
    let zoom = options.zooms[verdict.zoom];
    let holds = if verdict.holds() { "holds" } else { "FAILS" };
    format!(
        "{holds}: {reached} of {files} files {kind} patches ({share:.1}%, {wanted}% wanted) reach \
         {db} dB or the truth's noise at {zoom}x"
    )
}

/// Builds the release binary and says where it is.
fn build(ws: &Workspace) -> Result<PathBuf> {
    let mut cargo = ws.cargo(&["build", "--release", "--locked", "--package", "vtex"]);
    ensure!(cargo.status()?.success(), "vtex does not build");
    let metadata = ws.metadata()?;
    let target = metadata["target_directory"]
        .as_str()
        .context("no target folder")?;
    Ok(Path::new(target).join("release/vtex"))
}
