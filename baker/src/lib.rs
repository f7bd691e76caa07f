//! SVG in, [`VtexFile`](vtex_format::VtexFile) out: pure, deterministic at any thread count.

mod cells;
mod classify;
mod config;
mod drawing;
mod encode;
#[cfg(test)]
mod encode_tests;
mod error;
mod geometry;
mod grid;
mod msdf;
mod paint_table;
mod placed;
mod prepare;
mod subset;
#[cfg(test)]
mod testing;

pub use config::{BakeConfig, Mode, Resources, Stage};
pub use error::BakeError;
