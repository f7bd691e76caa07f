//! What `cargo xtask corpus` was asked for.

use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};

use super::bars::Bars;

/// How the tool is called.
pub(crate) const USAGE: &str = "\
usage: cargo xtask corpus DIR [OPTION...] [-- BAKE-OPTION...]

Bakes every .svg and .svgz below DIR (but not below a folder `hostile`), each in a child process,
compares it with its SVG, and writes corpus.csv and corpus.html, worst first. Exits with 7 when a
file fails or too many miss their bar.

  --out DIR         where to write; default target/corpus
  --vtex FILE       the vtex to run; default: target/release/vtex, built first
  --zoom Z,...      zooms to compare at; default 1,8
  --windows N       places that zooms above 1 are compared in; default 4
  --size N          pixels of the pictures' longer side; default 512
  --spp N           samples a pixel; default 16
  --max-zoom Z      of the bake
  --bar DB[,...]    what every file must reach: one bar for all zooms, or one for each. Default:
                    without raster patches 40 dB at 1x for 99% of files and 38 dB at 8x for 97%,
                    with patches 35 dB at 1x for 97%. Where the truth's own noise lies below a bar,
                    that noise is the bar
  --only-native     compare only files that need no raster patch
  --filter SUBSTR   only files whose path below DIR contains SUBSTR
  --pictures N      show SVG, vtex and their difference for the N worst files; default 0
  --jobs N          files at a time; default: one a core
  --timeout S       seconds each child process may take; default 60";

/// The options, checked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Options {
    pub(crate) folder: PathBuf,
    pub(crate) out: PathBuf,
    /// `None`: build one.
    pub(crate) vtex: Option<PathBuf>,
    /// At least one.
    pub(crate) zooms: Vec<f64>,
    pub(crate) windows: u32,
    pub(crate) size: u32,
    pub(crate) spp: u32,
    pub(crate) bars: Bars,
    pub(crate) only_native: bool,
    pub(crate) filter: String,
    pub(crate) pictures: usize,
    pub(crate) jobs: usize,
    pub(crate) timeout: Duration,
    /// Handed to `vtex bake`.
    pub(crate) bake: Vec<String>,
}

impl Options {
    /// Reads a command line without the program and `corpus`.
    pub(crate) fn parse(arguments: &[String]) -> Result<Self> {
        let mut options = Self::default();
        let mut folder = None;
        let mut strict = Vec::new();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            let mut value = || {
                rest.next()
                    .with_context(|| format!("{argument} needs a value"))
            };
            match argument.as_str() {
                "--out" => options.out = value()?.into(),
                "--vtex" => options.vtex = Some(value()?.into()),
                "--zoom" => options.zooms = list(value()?)?,
                "--size" => options.size = number(value()?)?,
                "--spp" => options.spp = number(value()?)?,
                "--bar" => strict = list(value()?)?,
                "--windows" => options.windows = number(value()?)?,
                "--only-native" => options.only_native = true,
                "--filter" => options.filter.clone_from(value()?),
                "--pictures" => options.pictures = number(value()?)?,
                "--jobs" => options.jobs = number(value()?)?,
                "--timeout" => options.timeout = Duration::from_secs(number(value()?)?),
                "--max-zoom" => options.bake.extend([argument.clone(), value()?.clone()]),
                "--" => options.bake.extend(rest.by_ref().cloned()),
                name if name.starts_with("--") => bail!("no option {name}"),
                name => ensure!(
                    folder.replace(PathBuf::from(name)).is_none(),
                    "one folder at a time"
                ),
            }
        }
        options.folder = folder.context("which folder?")?;
        options.checked(&strict)
    }

    fn checked(mut self, strict: &[f64]) -> Result<Self> {
        self.bars = match *strict {
            [] => Bars::usual(&self.zooms),
            [bar] => Bars::strict(&vec![bar; self.zooms.len()]),
            _ => Bars::strict(strict),
        };
        ensure!(
            strict.len() < 2 || strict.len() == self.zooms.len(),
            "--bar wants one value, or one for each zoom"
        );
        ensure!(self.jobs > 0, "--jobs wants at least 1");
        Ok(self)
    }

    /// The zooms as `vtex compare` wants them.
    pub(crate) fn zoom_list(&self) -> String {
        let zooms: Vec<String> = self.zooms.iter().map(f64::to_string).collect();
        zooms.join(",")
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            folder: PathBuf::new(),
            out: "target/corpus".into(),
            vtex: None,
            zooms: vec![1.0, 8.0],
            windows: 4,
            size: 512,
            spp: 16,
            bars: Bars::default(),
            only_native: false,
            filter: String::new(),
            pictures: 0,
            jobs: std::thread::available_parallelism().map_or(1, usize::from),
            timeout: Duration::from_secs(60),
            bake: Vec::new(),
        }
    }
}

fn number<T: FromStr>(text: &str) -> Result<T> {
    text.parse()
        .ok()
        .with_context(|| format!("{text} is no number that fits here"))
}

fn list(text: &str) -> Result<Vec<f64>> {
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Options> {
        let arguments: Vec<String> = line.split(' ').map(str::to_owned).collect();
        Options::parse(&arguments)
    }

    #[test]
    fn a_bar_holds_for_every_zoom() {
        let options = parse("art --zoom 1,8,32 --bar 40 --max-zoom 64 -- --mode curves").unwrap();
        assert_eq!(options.bars, Bars::strict(&[40.0; 3]));
        assert_eq!(options.bake, ["--max-zoom", "64", "--mode", "curves"]);
        assert_eq!(
            parse("art --zoom 1,8 --bar 40,45").unwrap().bars,
            Bars::strict(&[40.0, 45.0])
        );
        assert_eq!(parse("art").unwrap().bars, Bars::usual(&[1.0, 8.0]));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for line in [
            "--spp 4",
            "art other",
            "art --zoom 1,8,32 --bar 40,45",
            "art --spp many",
            "art --nonsense",
            "art --jobs 0",
            "art --out",
        ] {
            assert!(parse(line).is_err(), "{line}");
        }
    }
}
