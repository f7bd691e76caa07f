//! How long each stage of a bake takes.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use rayon::prelude::*;
use vtex_baker::{BakeConfig, Resources, Stage};
use vtex_format::{VtexFile, WriteError};

use crate::report::{Cell, Table};
use crate::subject::{RASTER_SIZE, name, rasterise, read};
use crate::timing::{Spread, Trial, interleave};

/// Columns, in the order of [`Stage`].
const STAGES: [(Stage, &str); 8] = [
    (Stage::Parse, "parse"),
    (Stage::Draw, "draw"),
    (Stage::Prepare, "prepare"),
    (Stage::Pack, "pack"),
    (Stage::Cells, "cells"),
    (Stage::Msdf, "msdf"),
    (Stage::Encode, "encode"),
    (Stage::Mips, "mips"),
];

/// Milliseconds of every stage for each file on `threads` threads, and of rasterising the same
/// file with mips.
pub(crate) fn stages_table(
    files: &[PathBuf],
    resources: &Resources,
    threads: usize,
    rounds: usize,
) -> Result<Table> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let raster = format!("raster {RASTER_SIZE}^2");
    let mut columns = vec!["ms"];
    columns.extend(STAGES.iter().map(|(_, name)| *name));
    columns.extend(["to bytes", "KiB", "whole bake", raster.as_str()]);
    let plural = if threads == 1 { "" } else { "s" };
    let mut table = Table::new(format!("Bake stages, {threads} thread{plural}"), &columns);
    table.note(
        "Medians. `to bytes` compresses and hashes; nothing is written to disk. The last column is \
         resvg and a mip chain on one thread. Its ratio says how many times as fast as the bake \
         that is.",
    );
    for path in files {
        table.row(pool.install(|| row(path, resources, rounds))?);
    }
    Ok(table)
}

fn row(path: &Path, resources: &Resources, rounds: usize) -> Result<Vec<Cell>> {
    let svg = read(path)?;
    let name = name(path);
    let config = BakeConfig::default();
    let mut runs: Vec<Run> = Vec::new();
    let fail = || format!("cannot bake {name}");
    let trials = vec![
        Trial::timed(1, || {
            let (file, mut run) = bake(&svg, &config, resources).with_context(fail)?;
            let start = Instant::now();
            run.file_bytes = to_bytes(&file).with_context(fail)?.len();
            run.to_bytes = start.elapsed();
            let whole = run.whole();
            runs.push(run);
            Ok(whole)
        }),
        Trial::timed(1, || {
            let start = Instant::now();
            rasterise(&svg, resources, RASTER_SIZE).with_context(fail)?;
            Ok(start.elapsed())
        }),
    ];
    let timings = interleave(trials, rounds)?;
    // The first run was the warm-up.
    let runs = &runs[1..];
    let median = |of: &dyn Fn(&Run) -> Duration| {
        Spread::of(runs.iter().map(|run| of(run).as_secs_f64() * 1e3)).median
    };
    let mut cells = vec![Cell::Text(name.clone())];
    for (index, _) in STAGES.iter().enumerate() {
        cells.push(Cell::Number(median(&|run| run.stages[index]), 1));
    }
    cells.push(Cell::Number(median(&|run| run.to_bytes), 1));
    let bytes = runs.last().map_or(0, |run| run.file_bytes);
    cells.push(Cell::Number(bytes as f64 / 1024.0, 0));
    cells.push(Cell::Measured {
        value: timings[0].milliseconds(),
        ratio: None,
    });
    let ratio = Some(timings[1].speed_against(&timings[0]));
    cells.push(Cell::Measured {
        value: timings[1].milliseconds(),
        ratio,
    });
    Ok(cells)
}

/// The file, packed on all threads as `vtex bake` does.
fn to_bytes(file: &VtexFile) -> Result<Vec<u8>, WriteError> {
    let run = |count, job: &(dyn Fn(usize) + Sync)| (0..count).into_par_iter().for_each(job);
    file.to_bytes_by(&run)
}

/// One bake.
#[derive(Default)]
struct Run {
    /// As [`STAGES`].
    stages: [Duration; STAGES.len()],
    to_bytes: Duration,
    file_bytes: usize,
}

impl Run {
    fn whole(&self) -> Duration {
        self.stages.iter().sum::<Duration>() + self.to_bytes
    }
}

fn bake(svg: &[u8], config: &BakeConfig, resources: &Resources) -> Result<(VtexFile, Run)> {
    let marks = Mutex::new(Vec::new());
    let observer = |stage: Stage| {
        if let Ok(mut marks) = marks.lock() {
            marks.push((stage, Instant::now()));
        }
    };
    let file = vtex_baker::bake_observed(svg, config, resources, &observer)?;
    let baked = Instant::now();
    let marks = marks.into_inner().unwrap_or_default();
    let ends = marks.iter().skip(1).map(|(_, begin)| *begin).chain([baked]);
    let mut stages = [Duration::ZERO; STAGES.len()];
    // A stage may begin more than once.
    for ((stage, begin), end) in marks.iter().zip(ends) {
        if let Some(index) = STAGES.iter().position(|(known, _)| known == stage) {
            stages[index] += end - *begin;
        }
    }
    let run = Run {
        stages,
        ..Run::default()
    };
    Ok((file, run))
}
