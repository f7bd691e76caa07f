//! Why a command failed: the exit code and a message.

use std::fmt;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use vtex_runtime::RuntimeError;
use vtex_truth::TruthError;

/// Exit codes of the `vtex` command. Scripts depend on the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
pub(crate) enum ExitCode {
    /// Success.
    Ok = 0,
    /// The command line is wrong.
    Usage = 1,
    /// A file could not be read or written.
    Io = 2,
    /// An input file is invalid.
    InvalidInput = 3,
    /// A failure at run time: no GPU adapter, a lost device, a bug of ours.
    Runtime = 4,
    /// A feature that this version does not support.
    Unsupported = 5,
    /// `compare --min-psnr` or `bake --check` found a difference.
    Difference = 7,
    /// A limit was exceeded: on the drawing, on time or on memory.
    Limit = 8,
}

/// One failure: a line on standard error and an exit code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Failure {
    /// The exit code of the process, unless another file has a higher one.
    pub(crate) code: ExitCode,
    /// What happened to which file and what to do about it, without full stop or newline at the
    /// end.
    pub(crate) message: String,
    /// Whether to print nothing: the reader of our output has closed the pipe, as `head` does.
    pub(crate) silent: bool,
}

/// Result of a command or a part of it.
pub(crate) type Outcome<T> = Result<T, Failure>;

impl Failure {
    /// A failure with a message; newlines in it become spaces, so that one failure is one line.
    pub(crate) fn new(code: ExitCode, message: impl fmt::Display) -> Self {
        let message = message.to_string();
        Self {
            code,
            message: message.split_whitespace().collect::<Vec<_>>().join(" "),
            silent: false,
        }
    }

    /// The command line is wrong.
    pub(crate) fn usage(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Usage, message)
    }

    /// An input file is invalid.
    pub(crate) fn invalid(path: &Path, message: impl fmt::Display) -> Self {
        Self::new(
            ExitCode::InvalidInput,
            format!("{}: {message}", path.display()),
        )
    }

    /// Something failed at run time.
    pub(crate) fn runtime(message: impl fmt::Display) -> Self {
        Self::new(ExitCode::Runtime, message)
    }

    /// `action` on `path` failed.
    pub(crate) fn io(action: &str, path: &Path, error: &io::Error) -> Self {
        let mut failure = Self::new(
            ExitCode::Io,
            format!("{}: cannot {action}: {error}", path.display()),
        );
        // `vtex info x | head -1`: the reader has seen enough, which is no failure.
        if error.kind() == io::ErrorKind::BrokenPipe {
            failure.code = ExitCode::Ok;
            failure.silent = true;
        }
        failure
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

impl From<RuntimeError> for Failure {
    fn from(error: RuntimeError) -> Self {
        let code = match error {
            RuntimeError::Limit(_) => ExitCode::Limit,
            RuntimeError::Unsupported(_) => ExitCode::Unsupported,
            RuntimeError::Parameter(_) => ExitCode::Usage,
            _ => ExitCode::Runtime,
        };
        Self::new(code, error)
    }
}

impl From<TruthError> for Failure {
    fn from(error: TruthError) -> Self {
        match error {
            TruthError::Gpu(error) => error.into(),
            error => Self::runtime(error),
        }
    }
}
