//! The `vtex` command; [`run`] is the whole of it.
//!
//! One room for each job: `cli` talks to the user, `command` has one file for each subcommand,
//! `baking` turns SVG into `.vtex` in limited processes, `texture` looks at `.vtex` files, `files`
//! reads and writes.

mod baking;
mod cli;
mod command;
mod files;
mod texture;

pub use command::run;
