//! SVG in, [`VtexFile`] out: pure, deterministic at any thread count.
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
mod oracle;
mod pipeline;
mod raster;
mod svg;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod warning;

use drawing::Drawing;
use raster::{
    canvas,
    patch::{self, PatchSettings},
};
use svg::WalkOptions;
use vtex_format::{VtexFile, WarningCode};
use warning::Warnings;

pub use config::{BakeConfig, ImageReader, Mode, Resources, Stage};
pub use error::BakeError;
pub use oracle::Painter;
pub use svg::font_selector;

/// Bakes `svg`, the bytes of an SVG or gzipped SVG. What was approximated or left out stands in
/// the warnings of the file's provenance.
///
/// # Errors
/// [`BakeError::Svg`] for bytes that are no SVG with an area, [`BakeError::Parameter`] for an
/// option out of its range, [`BakeError::Limit`] for a drawing beyond a budget.
pub fn bake(svg: &[u8], config: &BakeConfig, resources: &Resources) -> Result<VtexFile, BakeError> {
    bake_observed(svg, config, resources, &|_| ())
}

/// As [`bake`]; `observer` is told each [`Stage`] as it begins, for progress and timing.
///
/// # Errors
/// As [`bake`].
pub fn bake_observed(
    svg: &[u8],
    config: &BakeConfig,
    resources: &Resources,
    observer: &(dyn Fn(Stage) + Sync),
) -> Result<VtexFile, BakeError> {
    config.check()?;
    let mut drawing = draw(svg, config, resources, observer)?;
    if config.mode == Mode::Raster {
        drawing = pipeline::rastered(drawing, config, observer)?;
    }
    let mip0 = canvas::canvas_texels(drawing.canvas_size, config.mip0_size);
    let source_hash = *blake3::hash(svg).as_bytes();
    pipeline::assemble(drawing, Some(mip0), config, source_hash, observer)
}

/// The front half: SVG bytes to a drawing.
fn draw(
    svg: &[u8],
    config: &BakeConfig,
    resources: &Resources,
    observer: &(dyn Fn(Stage) + Sync),
) -> Result<Drawing, BakeError> {
    let warnings = Warnings::default();
    observer(Stage::Parse);
    let tree = svg::parse(svg, resources, &warnings)?;

    observer(Stage::Draw);
    let options = WalkOptions {
        max_zoom: f64::from(config.max_zoom),
        fill_color: config.fill_color,
        stroke_color: config.stroke_color,
    };
    let plan = svg::plan(&tree, options, &warnings)?;
    let settings = PatchSettings::new(plan.canvas_size, config);
    let (items, tree) = patch::resolve(plan, settings, &warnings);
    if items.is_empty() {
        warnings.push(
            WarningCode::EmptyDrawing,
            "svg",
            "",
            "the drawing shows nothing",
        );
    }
    Ok(Drawing {
        canvas_size: settings.canvas_size,
        items,
        tree,
        warnings: warnings.into_list(),
    })
}

/// The examples of README.md, which run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
