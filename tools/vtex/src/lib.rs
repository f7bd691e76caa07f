//! The parts of the `vtex` command that tests and benches use too: the resvg reference, picture
//! metrics, previews and comparisons.
//!
//! [`mod@reference`] draws the truth, [`preview`] shoots pictures of a texture, [`metrics`] says how
//! far they are apart, [`comparison`] does all three at a zoom. [`command::run`] is the whole
//! command.

pub mod args;
pub mod baking;
pub mod cache;
pub mod color;
pub mod command;
pub mod comparison;
pub mod console;
pub mod failure;
pub mod fonts;
pub mod heat;
pub mod images;
pub mod input;
mod lattice;
mod memory;
pub mod metrics;
pub mod output;
pub mod page;
pub mod patches;
pub mod picture;
mod plain;
pub mod preview;
pub mod raster;
pub mod reference;
pub mod srgb;
mod strokes;
pub mod texture;
pub mod tracing;
pub mod walk;
pub mod windows;
mod wire;
mod workers;
