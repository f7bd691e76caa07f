//! SVG in, [`VtexFile`](vtex_format::VtexFile) out: pure, deterministic at any thread count.

mod config;
mod drawing;
mod error;

pub use config::{BakeConfig, Mode, Resources, Stage};
pub use error::BakeError;
