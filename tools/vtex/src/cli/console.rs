//! Output: results on standard output, everything else on standard error.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{Failure, Outcome};

/// Format of the results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Format {
    /// Text for people
    #[default]
    Text,
    /// JSON for programs
    Json,
}

/// How much is printed on standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verbosity {
    /// Failures only.
    Quiet,
    /// Also warnings and one line for each result.
    #[default]
    Normal,
    /// Also details of the work, and all warnings.
    Verbose,
}

/// A number of things, with the plural of most nouns.
pub(crate) fn counted<N: Display + PartialEq + From<u8>>(count: N, noun: &str) -> String {
    let ending = match noun.ends_with("ch") {
        _ if count == N::from(1) => "",
        true => "es",
        false => "s",
    };
    format!("{count} {noun}{ending}")
}

/// Prints what a command has to say.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Console {
    /// How much is printed.
    pub(crate) verbosity: Verbosity,
    /// Format of the results.
    pub(crate) format: Format,
}

impl Console {
    /// Writes a result to stdout.
    ///
    /// # Errors
    /// When standard output cannot be written. A closed pipe is a silent failure.
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

    /// Prints what was done, unless `--quiet`.
    pub(crate) fn note(&self, text: &str) {
        if self.verbosity >= Verbosity::Normal {
            tell(text);
        }
    }

    /// Prints details, with `--verbose`.
    pub(crate) fn detail(&self, text: &str) {
        if self.verbosity >= Verbosity::Verbose {
            tell(text);
        }
    }

    /// Prints a failure, always.
    pub(crate) fn failure(&self, failure: &Failure) {
        if !failure.silent {
            tell(&format!("vtex: {failure}"));
        }
    }

    /// A progress bar over `length` steps. It appears after a second, and only on a terminal.
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

/// A progress bar on standard error; see [`Console::progress`].
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    wanted: bool,
}

impl Progress {
    /// Counts one more step as done.
    pub(crate) fn step(&self) {
        self.steps(1);
    }

    /// Counts more steps as done.
    pub(crate) fn steps(&self, count: u64) {
        if self.wanted && self.bar.is_hidden() && self.begun.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(count);
    }

    /// Changes how many steps there will be, those that are done included.
    pub(crate) fn expect(&self, length: u64) {
        self.bar.set_length(length);
    }

    /// Changes what stands before the bar, 20 letters at most.
    pub(crate) fn say(&self, what: String) {
        self.bar.set_message(what);
    }

    /// Whether anybody sees the bar.
    pub(crate) fn is_shown(&self) -> bool {
        !self.bar.is_hidden()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn tell(text: &str) {
    // When standard error is closed, there is nowhere left to report that.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_thing_is_singular() {
        assert_eq!(counted(0_usize, "layer"), "0 layers");
        assert_eq!(counted(1_u64, "raster patch"), "1 raster patch");
        assert_eq!(counted(2_u32, "raster patch"), "2 raster patches");
        assert_eq!(counted(1.0_f32, "texel"), "1 texel");
        assert_eq!(counted(1.5_f32, "texel"), "1.5 texels");
    }
}
