//! SVG in, [`VtexFile`](vtex_format::VtexFile) out: pure, deterministic at any thread count.

mod color;
mod config;
mod drawing;
mod error;
mod mips;
mod patch;
mod raster;
mod resample;
mod stroke;
mod svg;
mod warning;

use drawing::{Drawing, Item};
use patch::PatchSettings;
use svg::WalkOptions;
use vtex_format::WarningCode;
use warning::Warnings;

pub use config::{BakeConfig, Mode, Resources, Stage};
pub use error::BakeError;

#[cfg(test)]
mod picture_tests;

/// The front half: SVG bytes to a drawing.
#[cfg_attr(not(test), expect(dead_code, reason = "the back half calls it"))]
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
    let plan = svg::plan(&tree, options, &warnings);
    let settings = PatchSettings {
        canvas_size: plan.canvas_size,
        mip0_size: config.mip0_size,
        max_zoom: f64::from(config.max_zoom),
    };
    let mut items = patch::resolve(plan, settings, &warnings);
    if items.is_empty() {
        warnings.push(
            WarningCode::EmptyDrawing,
            "svg",
            "",
            "the drawing shows nothing",
        );
    }
    if config.mode == Mode::Raster {
        let patch = patch::whole_canvas(&items, settings, &warnings);
        items = patch.map(Item::Patch).into_iter().collect();
    }
    Ok(Drawing {
        canvas_size: settings.canvas_size,
        items,
        warnings: warnings.into_list(),
    })
}
