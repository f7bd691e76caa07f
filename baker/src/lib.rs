//! SVG in, [`VtexFile`] out.
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
//! # Guarantees
//!
//! A bake is a pure function of its three arguments. It opens no file, reads no clock and starts no
//! process, and it gives the same bytes at any number of threads. It uses the rayon pool of the
//! thread that calls it.
//!
//! The file holds a list of warnings ([`Provenance::warnings`]): each names what in the SVG was
//! approximated or left out. Fonts and images come from [`Resources`] alone; without them text and
//! linked images are left out with a warning.
//!
//! # Untrusted input
//!
//! A bake refuses input that asks for too much with [`BakeError::Limit`] before it starts the work.
//! It bounds the bytes of the text (compressed, decompressed and with entities expanded), nodes,
//! segments, nesting, pixels of images, and the work of filters.
//!
//! Three things remain for the caller:
//! - A call cannot be cancelled.
//! - The process ends if the system refuses an allocation.
//! - The process ends if a stack is too small. SVG may nest 1024 levels deep, which takes a stack
//!   of 64 MiB on each thread of the rayon pool.
//!
//! Bake untrusted input in a separate process with limits of time and memory, and in a rayon pool
//! with such stacks. `vtex bake` does both.
//!
//! # Inside
//!
//! Data flows through the folders in this order: `svg` reads the text, has `style` put attributes in
//! place of styles that usvg does not know, and walks the tree, `drawing`
//! holds the result, `geometry` prepares outlines, `coverage` decides how each shape covers the
//! cells of a grid, `cells` builds the list of each cell, `raster` makes patches and mips.
//! `pipeline` runs these stages; read it first.
//!
//! [`VtexFile`]: vtex_format::VtexFile
//! [`Provenance::warnings`]: vtex_format::Provenance::warnings

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
mod style;
mod svg;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod warning;

pub use config::{BakeConfig, ImageReader, Mode, Profile, Resources, Stage};
pub use error::BakeError;
pub use pipeline::{bake, bake_observed};
pub use svg::{font_selector, styled_text};

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
