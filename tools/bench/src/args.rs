//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};

use crate::isa::Chip;

/// Times the stages of bakes, lookups per second by filter mode, and rays per second, and prints the
/// machine and the adapter they ran on.
///
/// Run it as `cargo run --release -p vtex-bench`. After one warm-up run, which also compiles the
/// shaders, each round runs all trials of a table once, in turn. A figure is the median of the
/// rounds with its range in brackets; `x` is its speed as a multiple of the table's baseline: the
/// median of the ratios within rounds. On a busy or shared machine rely on the ratios only.
#[derive(Debug, Parser)]
#[command(version)]
pub(crate) struct Args {
    /// SVG files. The default is the samples of `tests/data/svg/paper` and, if there is a corpus
    /// (`VTEX_CORPUS`, else `../shared/corpus`), its folder `paper5`.
    pub(crate) files: Vec<PathBuf>,
    /// Measure only these parts.
    #[arg(long, value_delimiter = ',')]
    pub(crate) only: Vec<Part>,
    /// All tables of a graphics card (parts gpu, rays, parity, isa and load) in less than five
    /// minutes.
    /// Refuses an adapter in software. Writes vtex-bench.md and vtex-bench.json unless --markdown
    /// and --json name other files.
    #[arg(long, conflicts_with = "only")]
    pub(crate) card: bool,
    /// Let --card measure an adapter in software: for trying the command, not for figures.
    #[arg(long, requires = "card")]
    pub(crate) allow_software: bool,
    /// Rounds after the warm-up [default: 5; with --card 7].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) rounds: Option<u16>,
    /// Lookups per run on the GPU, in units of 2^18 (one window of 512 x 512) [default: 4; with
    /// --card 64].
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub(crate) windows: Option<u16>,
    /// Chips that the part isa compiles for: `own`, the machine's own by its own driver, and any of
    /// AMD's by the names of `RADV_FORCE_FAMILY`, which takes Mesa's RADV but no such chip.
    #[arg(long, value_delimiter = ',', default_value = "own,navi21,vega10")]
    pub(crate) chips: Vec<Chip>,
    /// Write the tables as Markdown.
    #[arg(long, value_name = "FILE")]
    pub(crate) markdown: Option<PathBuf>,
    /// Only rasterise the one SVG file to this PNG, with 4096 pixels along its longer side and on one
    /// thread, and print the milliseconds of parsing, rendering, encoding and writing. The part
    /// `processes` runs this program so, as the rival of `vtex bake`.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["only", "card", "markdown", "json"])]
    pub(crate) png: Option<PathBuf>,
    /// Write everything as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// The part isa runs this program so.
    #[arg(long, hide = true)]
    pub(crate) isa_compile: bool,
}

/// What to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Bake stages of each file.
    Bake,
    /// Lookups by the CPU twin.
    Cpu,
    /// Lookups on the GPU, beside the raster in RGBA8 and BC7 and beside a loop over outlines.
    Gpu,
    /// Rays of the path tracer.
    Rays,
    /// Largest differences between lookups on the GPU and by the CPU twin.
    Parity,
    /// Instructions, registers and the like of the shaders, as drivers report them; nothing is run.
    /// Usual feature sets, or those of the files if files are named. Where a driver is missing, a
    /// sentence says so and the other parts go on; it is an error if no driver is there and this is
    /// the only part.
    Isa,
    /// Bytes of each file and of its rivals.
    Sizes,
    /// Bytes on the GPU and load times, of each file and of its rivals. Needs no graphics card.
    Load,
    /// Sets of 1 to 1,000 textures in one pipeline: bytes, load times, pipelines, lookups. Not part of the
    /// default.
    Set,
    /// Whole processes: `vtex bake`, which must be built in the same folder as this program, and
    /// resvg to a PNG. Not part of the default.
    Processes,
}

impl Args {
    /// Whether the command line asks for a part.
    pub(crate) fn wants(&self, part: Part) -> bool {
        if self.card {
            let about_gpus = [Part::Gpu, Part::Rays, Part::Parity, Part::Isa, Part::Load];
            return about_gpus.contains(&part);
        }
        match self.only.is_empty() {
            true => ![Part::Processes, Part::Set].contains(&part),
            false => self.only.contains(&part),
        }
    }

    /// Where the tables go as Markdown and as JSON.
    pub(crate) fn outputs(&self) -> [Option<PathBuf>; 2] {
        let named = [&self.markdown, &self.json].map(Clone::clone);
        match self.card {
            true => {
                let [markdown, json] = named;
                [
                    markdown.or_else(|| Some("vtex-bench.md".into())),
                    json.or_else(|| Some("vtex-bench.json".into())),
                ]
            }
            false => named,
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
        let parse = |words: &[&str]| Args::try_parse_from([&["vtex-bench"], words].concat());
        assert!(parse(&["--allow-software"]).is_err(), "it is about --card");
        assert!(parse(&["--card", "--only", "gpu"]).is_err());
        let card = parse(&["--card", "--json", "a.json"]).unwrap();
        assert!(card.wants(Part::Isa) && !card.wants(Part::Cpu));
        assert_eq!(
            card.outputs(),
            [Some("vtex-bench.md".into()), Some("a.json".into())]
        );
        let plain = parse(&[]).unwrap();
        assert!(plain.wants(Part::Isa) && !plain.wants(Part::Processes) && !plain.wants(Part::Set));
        assert_eq!(plain.outputs(), [None, None]);
    }
}
