//! Why a command failed: exit code, who, where, what to do.

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
    /// All went well.
    Ok = 0,
    /// The command line is wrong.
    Usage = 1,
    /// A file could not be read or written.
    Io = 2,
    /// An input file is not what it should be.
    InvalidInput = 3,
    /// Something that should work did not: GPU, adapter, our own bug.
    Runtime = 4,
    /// A feature that this version does not have.
    Unsupported = 5,
    /// `compare`, `bake --check`: there is a difference.
    Difference = 7,
    /// A budget was exceeded, of the drawing, of time or of memory.
    Limit = 8,
}

/// One failure: one line on stderr and an exit code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Failure {
    /// What the process returns.
    pub(crate) code: ExitCode,
    /// Where it happened and what to do, without a trailing full stop or newline.
    pub(crate) message: String,
    /// Nothing is printed: the reader of our output went away, which is its right.
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

    /// An input file is not what it should be.
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
        // `vtex info x | head -1`: whoever reads us has seen enough.
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
