//! `vtex-bench`: how long bakes, lookups and rays take on this machine, beside their rivals.

mod clock;
mod device;
mod machine;
mod queries;
mod raster;
mod report;
mod rivals;
mod sfg22;
mod table;

use std::path::PathBuf;

use anyhow::Result;
use clap::{Parser, ValueEnum};

use crate::device::Device;
use crate::machine::Machine;
use crate::report::Report;
use crate::rivals::Effort;

/// Times bake stages, lookups a second per filter mode and rays a second, and prints the machine
/// and the adapter.
///
/// Run it as `cargo run --release -p vtex-bench`. Everything in a table is measured in turn within
/// each round, after one warm-up run that also compiles shaders. A figure is the median of the
/// rounds with its range in brackets; `x` is its ratio to the table's baseline, the median of the
/// ratios within rounds. On a busy or shared machine trust the ratios.
#[derive(Debug, Parser)]
#[command(version)]
struct Args {
    /// SVG files; without any, the samples of `tests/data/svg/paper` and, where the folder exists,
    /// those of `paper5` in the corpus (`VTEX_CORPUS`, else `../shared/corpus`).
    files: Vec<PathBuf>,
    /// Only these parts.
    #[arg(long, value_delimiter = ',')]
    only: Vec<Part>,
    /// Timed runs of everything after the warm-up.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..))]
    rounds: u16,
    /// Lookups a run on the GPU, in units of 2^18 (one 512 x 512 window).
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..=16))]
    windows: u16,
    /// Writes the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Writes everything as JSON.
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
}

fn main() -> Result<()> {
    let args = Args::parse();
    let wanted = |part| args.only.is_empty() || args.only.contains(&part);
    let effort = Effort {
        rounds: usize::from(args.rounds),
        gpu_lookups: usize::from(args.windows) << 18,
        cpu_lookups: 1 << 18,
    };
    let device = (wanted(Part::Gpu) || wanted(Part::Rays))
        .then(Device::open)
        .transpose()?;
    let mut report = Report::begin(Machine::detect(), device.as_ref())?;
    if let Some(device) = device.as_ref().filter(|_| wanted(Part::Gpu)) {
        report.add(rivals::sfg22_table(device, effort)?)?;
        report.add(rivals::minified_table(device, effort)?)?;
        report.add(rivals::fetch_table(device, effort)?)?;
    }
    report.finish(args.markdown.as_deref(), args.json.as_deref())
}
