//! SVG in, [`VtexFile`](vtex_format::VtexFile) out: pure, deterministic at any thread count.
//!
//! ```
//! use vtex_baker::{BakeConfig, Resources, bake};
//!
//! let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10">
//!   <rect width="20" height="10" fill="#084"/><circle cx="10" cy="5" r="4" fill="#fff"/></svg>"##;
//! let file = bake(svg, &BakeConfig::default(), &Resources::default())?;
//! assert_eq!(file.shapes.len(), 2);
//! let bytes = file.to_bytes().expect("a baked file keeps the format's rules");
//! # let _ = bytes;
//! # Ok::<(), vtex_baker::BakeError>(())
//! ```
//!
//! The baker opens no file and starts no process. It refuses what asks for too much before work
//! starts ([`BakeError::Limit`]): bytes of text, packed, unpacked and with entities expanded; nodes,
//! segments and nesting; pixels of images; the work of filters. That bounds what is known to grow,
//! but a call cannot be cancelled, an allocation that the system refuses ends the process, and so
//! does a stack that is too small: up to 1024 levels nest, for which `vtex bake` gives the threads
//! of its rayon pool 64 MiB each. Who bakes input that nobody vouches for does that in such a pool
//! and in a process of its own with limits of time and memory, as `vtex bake` does.

mod cells;
mod config;
mod coverage;
mod drawing;
mod error;
mod geometry;
mod number;
#[cfg(any(test, feature = "oracle"))]
pub mod oracle;
mod pipeline;
mod raster;
mod svg;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod warning;

pub use config::{BakeConfig, ImageReader, Mode, Resources, Stage};
pub use error::BakeError;
pub use pipeline::{bake, bake_observed};
pub use svg::font_selector;

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
