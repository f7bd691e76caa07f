//! What the user sees: results on stdout, everything else on stderr.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Failure, Outcome};

/// How results are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    /// For people.
    #[default]
    Text,
    /// For programs.
    Json,
}

/// How much is told on stderr.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verbosity {
    /// Failures only.
    Quiet,
    /// Failures, warnings, one line a result.
    #[default]
    Normal,
    /// Also what is being done, and every warning.
    Verbose,
}

/// Where a command writes to.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Console {
    /// How much is told.
    pub(crate) verbosity: Verbosity,
    /// How results are written.
    pub(crate) format: Format,
}

impl Console {
    /// Writes a result to stdout.
    ///
    /// # Errors
    /// When stdout cannot be written; a closed pipe is a silent failure.
    pub(crate) fn result(&self, bytes: &[u8]) -> Outcome<()> {
        let mut stdout = io::stdout().lock();
        stdout
            .write_all(bytes)
            .and_then(|()| stdout.flush())
            .map_err(|error| Failure::io("write", Path::new("stdout"), &error))
    }

    /// Writes a value as indented JSON to stdout.
    ///
    /// # Errors
    /// As [`Self::result`].
    pub(crate) fn json(&self, value: &serde_json::Value) -> Outcome<()> {
        self.result(format!("{value:#}\n").as_bytes())
    }

    /// Tells what was done, unless `--quiet`.
    pub(crate) fn note(&self, text: &str) {
        if self.verbosity >= Verbosity::Normal {
            tell(text);
        }
    }

    /// Tells details, with `--verbose`.
    pub(crate) fn detail(&self, text: &str) {
        if self.verbosity >= Verbosity::Verbose {
            tell(text);
        }
    }

    /// Tells of a failure, always.
    pub(crate) fn failure(&self, failure: &Failure) {
        if !failure.silent {
            tell(&format!("vtex: {failure}"));
        }
    }

    /// A progress bar over `length` steps that shows itself on a terminal after a second.
    pub(crate) fn progress(&self, length: u64, what: &str) -> Progress {
        let wanted = self.verbosity >= Verbosity::Normal && io::stderr().is_terminal();
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        if let Ok(style) =
            ProgressStyle::with_template("{msg:20!} [{bar:32}] {pos}/{len} {elapsed} (eta {eta})")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_message(what.to_owned());
        Progress {
            bar,
            begun: Instant::now(),
            wanted,
        }
    }
}

/// A bar on stderr; see [`Console::progress`].
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    wanted: bool,
}

impl Progress {
    /// One step more is done.
    pub(crate) fn step(&self) {
        if self.wanted && self.bar.is_hidden() && self.begun.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn tell(text: &str) {
    // Nobody is left to hear that stderr is gone.
    let _ = writeln!(io::stderr().lock(), "{text}");
}
