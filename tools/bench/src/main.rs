//! `vtex-bench`: how long bakes, lookups and rays take on this machine, compared with their rivals.

mod report;
mod subject;
mod tables;
mod timing;

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::{Parser, ValueEnum};

use crate::report::Report;
use crate::subject::{Subject, find, system_fonts};
use crate::timing::{Device, Effort, Machine};

/// Times the stages of bakes, lookups per second by filter mode, and rays per second, and prints the
/// machine and the adapter they ran on.
///
/// Run it as `cargo run --release -p vtex-bench`. After one warm-up run, which also compiles the
/// shaders, each round runs all trials of a table once, in turn. A figure is the median of the
/// rounds with its range in brackets; `x` is its speed as a multiple of the table's baseline: the
/// median of the ratios within rounds. On a busy or shared machine rely on the ratios only.
#[derive(Debug, Parser)]
#[command(version)]
struct Args {
    /// SVG files. The default is the samples of `tests/data/svg/paper` and, if there is a corpus
    /// (`VTEX_CORPUS`, else `../shared/corpus`), its folder `paper5`.
    files: Vec<PathBuf>,
    /// Measure only these parts.
    #[arg(long, value_delimiter = ',')]
    only: Vec<Part>,
    /// Rounds after the warm-up.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Lookups per run on the GPU, in units of 2^18 (one window of 512 x 512).
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=16))]
    windows: u16,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Only rasterise the one SVG file to this PNG, with 4096 pixels along its longer side and on one
    /// thread, and print the milliseconds of parsing, rendering, encoding and writing. The part
    /// `processes` runs this program so, as the rival of `vtex bake`.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["only", "markdown", "json"])]
    png: Option<PathBuf>,
    /// Write everything as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// What to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Bake stages of each file.
    Bake,
    /// Lookups by the CPU twin.
    Cpu,
    /// Lookups on the GPU.
    Gpu,
    /// Rays of the path tracer.
    Rays,
    /// Bytes of each file and of its rivals.
    Sizes,
    /// Whole processes: `vtex bake`, which must be built in the same folder as this program, and
    /// resvg to a PNG. Not part of the default.
    Processes,
}

fn main() -> Result<()> {
    let args = Args::parse();
    if let Some(png) = &args.png {
        let [svg] = args.files.as_slice() else {
            bail!("--png takes one SVG file");
        };
        return tables::rasterise_to_png(svg, png);
    }
    let wanted = |part| args.only.is_empty() || args.only.contains(&part);
    let effort = Effort {
        rounds: usize::from(args.rounds),
        gpu_lookups: usize::from(args.windows) << 18,
        cpu_lookups: 1 << 18,
    };
    let paths = find(&args.files)?;
    let resources = system_fonts();
    let machine = Machine::detect();
    let cores = machine.cores();
    let device = (wanted(Part::Gpu) || wanted(Part::Rays))
        .then(Device::open)
        .transpose()?;
    let mut report = Report::begin(machine, device.as_ref(), resources.fonts.len())?;

    if wanted(Part::Bake) {
        report.add(tables::stages_table(&paths, &resources, 1, effort.rounds)?)?;
        if cores > 1 {
            report.add(tables::stages_table(
                &paths,
                &resources,
                cores,
                effort.rounds,
            )?)?;
        }
    }
    if wanted(Part::Sizes) {
        report.add_all(tables::size_tables(&paths, &resources)?)?;
    }
    if args.only.contains(&Part::Processes) {
        report.add_all(tables::process_tables(&paths, effort.rounds)?)?;
    }
    let subjects: Vec<Subject> = match wanted(Part::Cpu) || wanted(Part::Gpu) || wanted(Part::Rays)
    {
        true => paths
            .iter()
            .map(|path| Subject::bake(path, &resources))
            .collect::<Result<_>>()?,
        false => Vec::new(),
    };
    if wanted(Part::Cpu) {
        report.add(tables::count_table(&subjects, effort))?;
        report.add_all(tables::cpu_tables(&subjects, 1, effort)?)?;
        if cores > 1 {
            report.add_all(tables::cpu_tables(&subjects, cores, effort)?)?;
        }
    }
    if let Some(device) = device.as_ref().filter(|_| wanted(Part::Gpu)) {
        tables::check_queries(device)?;
        report.add_all(tables::gpu_tables(device, &subjects, effort)?)?;
        report.add(tables::sfg22_table(device, effort)?)?;
        report.add(tables::minified_table(device, effort)?)?;
        report.add(tables::fetch_table(device, effort)?)?;
    }
    if let Some(device) = device.as_ref().filter(|_| wanted(Part::Rays)) {
        let subjects: Vec<(PathBuf, Subject)> = paths.into_iter().zip(subjects).collect();
        report.add(tables::rays_table(device, &subjects, &resources, effort)?)?;
    }
    report.finish(args.markdown.as_deref(), args.json.as_deref())
}
