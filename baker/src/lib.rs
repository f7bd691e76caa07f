//! SVG in, [`VtexFile`](vtex_format::VtexFile) out: pure, deterministic at any thread count.

mod config;
#[cfg_attr(not(test), expect(dead_code, reason = "cells do not use it yet"))]
mod curves;
mod drawing;
mod error;

pub use config::{BakeConfig, Mode, Resources, Stage};
pub use error::BakeError;
