//! The file's provenance: what it was baked from, and what became of each shape.

use vtex_format::{Finding, Preparation, Provenance, ShapeReport, Warning};

use crate::{
    config::{BakeConfig, Profile},
    coverage::{
        placed::{Placed, PlacedKind},
        verdict::Coverage,
    },
    drawing::{Drawing, Item, ShapeSource},
    geometry::prepare::Note,
    raster::patch::SHAPE_FEATURE,
};

/// The provenance of the file.
pub(super) fn provenance(
    drawing: &Drawing,
    placed: &[Placed],
    config: &BakeConfig,
    source_hash: [u8; 32],
    warnings: Vec<Warning>,
) -> Provenance {
    Provenance {
        source_hash,
        tool: concat!("vtex-baker ", env!("CARGO_PKG_VERSION")).into(),
        options: options(config),
        shapes: drawing
            .items
            .iter()
            .zip(placed)
            .filter_map(report)
            .collect(),
        warnings,
    }
}

/// The report of an item; clips have none.
fn report((item, placed): (&Item, &Placed)) -> Option<ShapeReport> {
    let (element, source) = match item {
        Item::Shape(shape) => {
            let source = match shape.source {
                ShapeSource::Fill => "fill",
                ShapeSource::Stroke => "stroke",
            };
            (&shape.element, source)
        }
        Item::Image(image) => (&image.element, image.feature.as_str()),
        Item::Clip(_) => return None,
    };
    let report = ShapeReport {
        element: element.clone(),
        source: source.to_owned(),
        ..ShapeReport::default()
    };
    match &placed.kind {
        PlacedKind::Shape { note, verdict, .. } => Some(ShapeReport {
            preparation: preparation(*note),
            finding: verdict.finding,
            size_texels: match verdict.coverage {
                Coverage::Msdf => placed.size_texels(),
                Coverage::Curves => verdict.size_texels,
            },
            msdf_error: verdict.error,
            ..report
        }),
        PlacedKind::Image => Some(ShapeReport {
            finding: match item {
                Item::Image(image) if image.feature == SHAPE_FEATURE => Finding::TooManySegments,
                _ => Finding::None,
            },
            ..report
        }),
        PlacedKind::Clip => None,
    }
}

fn preparation(note: Note) -> Preparation {
    match note {
        Note::AsDrawn => Preparation::AsDrawn,
        Note::Simplified => Preparation::Simplified,
        Note::SecondMethod => Preparation::SecondMethod,
        Note::Failed => Preparation::Failed,
    }
}

/// Every option by its name on the command line, sorted.
fn options(config: &BakeConfig) -> Vec<(String, String)> {
    let list = |values: &[f32]| {
        let texts: Vec<String> = values.iter().map(f32::to_string).collect();
        texts.join(",")
    };
    let color = |color: Option<[f32; 4]>| color.map_or("none".into(), |color| list(&color));
    let address = config
        .address
        .map(|mode| format!("{mode:?}").to_lowercase());
    let mut options: Vec<(String, String)> = [
        ("address", address.join(",")),
        ("error", config.error_px.to_string()),
        ("fill-color", color(config.fill_color)),
        ("gpu-budget", config.gpu_budget_bytes.to_string()),
        ("mask", config.mask.to_string()),
        ("max-zoom", config.max_zoom.to_string()),
        ("merge", config.merge.to_string()),
        ("mode", format!("{:?}", config.mode).to_lowercase()),
        ("msdf-range", config.distance_range_texels.to_string()),
        ("msdf-size", config.msdf_size.to_string()),
        (
            "outline",
            config
                .outline_texels
                .map_or("none".into(), |w| w.to_string()),
        ),
        ("size", config.mip0_size.to_string()),
        ("smoothing", config.smoothing.to_string()),
        ("stroke-color", color(config.stroke_color)),
        ("transform", list(&config.texture_matrix)),
    ]
    .map(|(name, value)| (name.into(), value))
    .into();
    // What is small for all is not made longer by saying so.
    let profile = match config.profile {
        Profile::Size => None,
        Profile::Load => Some("load"),
        Profile::LoadFootprints => Some("load-footprints"),
    };
    options.extend(profile.map(|name| ("profile".into(), name.into())));
    options.sort();
    options
}
