//! The front half of a bake: from SVG bytes to a drawing.

use vtex_format::WarningCode;

use crate::{
    config::{BakeConfig, Resources, Stage},
    drawing::Drawing,
    error::BakeError,
    raster::patch::{self, PatchSettings},
    svg::{self, WalkOptions},
    warning::Warnings,
};

/// The drawing of an SVG: geometry as shapes, everything else as images.
///
/// # Errors
/// [`BakeError::Svg`] and [`BakeError::Limit`], see [`crate::bake`].
pub(crate) fn draw(
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
        longer_side_px: config.longer_side_px(),
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
