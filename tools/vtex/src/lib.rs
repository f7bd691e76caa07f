//! The `vtex` command; [`command::run`] is the whole of it.

pub mod args;
pub mod baking;
pub mod cache;
pub mod color;
pub mod command;
pub mod console;
pub mod failure;
pub mod fonts;
pub mod heat;
pub mod images;
pub mod input;
mod memory;
pub mod output;
pub mod texture;
pub mod tracing;
pub mod walk;
mod wire;
mod workers;
