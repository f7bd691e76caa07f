//! The stages of a bake in order: first [`draw`], from the SVG to a drawing, then [`assemble`],
//! from the drawing to the file.

mod assemble;
mod draw;
mod fallback;
mod gpu_budget;
mod layout;
mod provenance;
mod raster_mode;
mod records;
#[cfg(test)]
mod tests;
mod warnings;

use vtex_format::VtexFile;

use crate::{
    config::{BakeConfig, Mode, Resources, Stage},
    error::BakeError,
    raster::canvas,
};

pub(crate) use assemble::assemble;
pub(crate) use draw::draw;
pub(crate) use raster_mode::rastered;

/// Bakes the bytes of an SVG or a gzipped SVG. The warnings in the file's provenance say what was
/// approximated or left out.
///
/// # Errors
/// [`BakeError::Svg`] for bytes that are no SVG with an area, [`BakeError::Parameter`] for an
/// option out of its range, [`BakeError::Limit`] for a drawing that asks for too much.
pub fn bake(svg: &[u8], config: &BakeConfig, resources: &Resources) -> Result<VtexFile, BakeError> {
    bake_observed(svg, config, resources, &|_| ())
}

/// As [`bake`]. Calls `observer` with each [`Stage`] as it begins, for progress bars and timings.
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
        drawing = rastered(drawing, config, observer)?;
    }
    let mip0 = canvas::canvas_texels(drawing.canvas_size, config.mip0_size);
    let source_hash = *blake3::hash(svg).as_bytes();
    assemble(drawing, Some(mip0), config, source_hash, observer)
}
