//! [`Mode::Raster`]: the whole drawing as one image.

use super::assemble::assemble;
use crate::{
    config::{BakeConfig, Mode, Stage},
    drawing::{Drawing, Item, tree::Tree},
    error::BakeError,
    raster::{
        canvas,
        patch::{PatchSettings, whole_canvas},
    },
};

/// The drawing as one image.
///
/// The drawing is baked as curves first, and the image is averaged from lookups in that file: it
/// shows what a vector file would.
///
/// # Errors
/// As [`assemble`].
pub(crate) fn rastered(
    drawing: Drawing,
    config: &BakeConfig,
    observer: &(dyn Fn(Stage) + Sync),
) -> Result<Drawing, BakeError> {
    if drawing.items.is_empty() {
        return Ok(drawing);
    }
    let canvas_size = drawing.canvas_size;
    let settings = PatchSettings::new(canvas_size, config);
    let plain = BakeConfig {
        mode: Mode::Curves,
        mask: false,
        outline_texels: None,
        merge: false,
        ..config.clone()
    };
    let mut file = assemble(drawing, None, &plain, [0; 32], observer)?;
    let (patch, coarse) = whole_canvas(settings, |size| canvas::picture(&file, size));
    let mut warnings = file.provenance.take().map(|told| told.warnings);
    let mut warnings = warnings.take().unwrap_or_default();
    warnings.extend(coarse);
    Ok(Drawing {
        canvas_size,
        items: vec![Item::Image(patch)],
        tree: Tree::ungrouped(1),
        warnings,
    })
}
