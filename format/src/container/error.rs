//! Who is at fault, where, and what to do.

use super::issue::{Fault, Issue};

/// Why bytes could not be read: the first issue found, by whose fault it is.
/// [`crate::validate`] finds the others.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file is broken.
    #[error("malformed .vtex file: {issue}; fetch or bake it again")]
    Malformed {
        /// What is wrong and where.
        issue: Issue,
    },
    /// The file is of a later kind.
    #[error("unsupported .vtex file: {issue}; read it with a newer version of vtex")]
    Unsupported {
        /// What is not known and where.
        issue: Issue,
    },
    /// The file is of an earlier version of the format.
    #[error("outdated .vtex file: {issue}; bake it again: `vtex bake drawing.svg -o drawing.vtex`")]
    Outdated {
        /// Which version and where.
        issue: Issue,
    },
    /// The file asks for more than the caller grants.
    #[error(".vtex file beyond the limits: {issue}; raise the limits if you trust it")]
    Limits {
        /// Which budget and where.
        issue: Issue,
    },
}

impl ReadError {
    /// The issue, whoever is at fault.
    pub fn issue(&self) -> &Issue {
        match self {
            Self::Malformed { issue }
            | Self::Unsupported { issue }
            | Self::Outdated { issue }
            | Self::Limits { issue } => issue,
        }
    }
}

impl From<Issue> for ReadError {
    fn from(issue: Issue) -> Self {
        match issue.fault {
            Fault::Malformed => Self::Malformed { issue },
            Fault::Unsupported => Self::Unsupported { issue },
            Fault::Outdated => Self::Outdated { issue },
            Fault::Limits => Self::Limits { issue },
        }
    }
}

/// Why a value could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The value breaks a rule of the format: the program that made it is wrong.
    #[error("cannot write .vtex: {issue}")]
    Invalid {
        /// The first of [`crate::VtexFile::check`].
        issue: Issue,
    },
    /// The compressor failed, which only a lack of memory explains.
    #[error("cannot write .vtex: zstd: {0}")]
    Compress(#[source] std::io::Error),
}

impl From<Issue> for WriteError {
    fn from(issue: Issue) -> Self {
        Self::Invalid { issue }
    }
}
