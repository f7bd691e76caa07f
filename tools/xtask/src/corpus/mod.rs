//! `cargo xtask corpus`: every SVG of a folder baked and measured, as a table.

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

use crate::workspace::Workspace;
use measure::Bench;
use options::Options;
use row::Row;

pub(crate) use options::USAGE;

/// Folder that is left out: its files are made to break readers.
const HOSTILE: &str = "hostile";

/// The table for programs.
const CSV: &str = "corpus.csv";

/// Measures as asked for and writes both tables. False when a file failed or missed its bar.
pub(crate) fn run(ws: &Workspace, arguments: &[String]) -> Result<bool> {
    let options = Options::parse(arguments).map_err(|error| error.context(USAGE))?;
    let mut files = Vec::new();
    find(&options.folder, "", &mut files)?;
    files.retain(|file| file.contains(&options.filter));
    files.sort();
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

/// Says in a few lines what came out.
fn report(rows: &[Row], options: &Options, html: &Path) -> bool {
    let missed: Vec<&Row> = rows
        .iter()
        .filter(|row| row.misses(&options.bars))
        .collect();
    for row in &missed {
        let zooms: Vec<String> = row
            .zooms
            .iter()
            .map(|zoom| format!("{:.1}", zoom.psnr_db))
            .collect();
        println!(
            "{}: {}",
            row.file,
            row.error.clone().unwrap_or_else(|| zooms.join(" "))
        );
    }
    let compared = rows.iter().filter(|row| !row.zooms.is_empty()).count();
    let solid = rows.iter().filter(|row| row.content.solid).count();
    println!(
        "{} files, {solid} without raster patches, {compared} compared, {} failed or below the bar",
        rows.len(),
        missed.len()
    );
    for (index, zoom) in options.zooms.iter().enumerate() {
        let all = totals::Totals::by_folder(rows, options.zooms.len(), &options.bars).pop();
        if let Some([least, median]) = all.and_then(|(_, all)| all.least_and_median(index)) {
            println!("{zoom:>5}x: least {least:.1} dB, median {median:.1} dB");
        }
    }
    println!("{}", html.display());
    missed.is_empty()
}

/// Paths below `root` of all SVG files in `folder`.
fn find(root: &Path, folder: &str, files: &mut Vec<String>) -> Result<()> {
    let path = root.join(folder);
    let entries = std::fs::read_dir(&path).with_context(|| path.display().to_string())?;
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let below = if folder.is_empty() {
            name.clone()
        } else {
            format!("{folder}/{name}")
        };
        let is_svg = name.rsplit_once('.').is_some_and(|(_, end)| {
            ["svg", "svgz"]
                .iter()
                .any(|known| end.eq_ignore_ascii_case(known))
        });
        if entry.path().is_dir() {
            if name != HOSTILE {
                find(root, &below, files)?;
            }
        } else if is_svg {
            files.push(below);
        }
    }
    Ok(())
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
