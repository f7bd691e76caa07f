//! How the command talks to its user: the command line, what is printed, exit codes.

pub(crate) mod args;
mod console;
mod failure;
pub(crate) mod light;
pub(crate) mod lookup;
mod panics;
mod values;

pub(crate) use console::{Console, Format, Verbosity, counted};
pub(crate) use failure::{ExitCode, Failure, Outcome};
pub(crate) use panics::{keep_places, panicked};
pub(crate) use values::{Profile, Size};
