//! The file's records: what the bake decided, as the format stores it.

use kurbo::{Rect, Shape as _};
use vtex_format::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, CurveLattice, FILL_EVEN_ODD, FILL_NON_ZERO,
    Finding, Image, Meta, Outline, Preparation, Provenance, SamplerSettings, ShapeRecord,
    ShapeReport, Warning, WarningCode,
};

use crate::{
    cells::{CellInput, CellLists, packing::Packing},
    config::BakeConfig,
    coverage::{
        grid::Lattice,
        judge::{Coverage, size_texels},
        placed::{Placed, PlacedKind},
        scales::Scales,
    },
    drawing::{Drawing, FillRule, Item, ShapeSource, to_f32},
    geometry::prepare::Note,
    raster::{canvas, patch::SHAPE_FEATURE},
};

/// The file's general record.
pub(crate) fn meta(
    drawing: &Drawing,
    config: &BakeConfig,
    lattice: &Lattice,
    curve_lattice: Option<CurveLattice>,
    scales: &Scales,
    outline: Option<Outline>,
) -> Meta {
    Meta {
        canvas_size: drawing.canvas_size.map(to_f32),
        grid: lattice.grid,
        distance_range_texels: to_f32(scales.range),
        max_zoom: config.max_zoom,
        curve_lattice,
        sampler: SamplerSettings {
            texture_matrix: config.texture_matrix,
            address: config.address,
            smoothing: config.smoothing,
            mask: config.mask,
            outline,
        },
    }
}

/// One record an item that is painted.
pub(crate) fn shape_records(input: &CellInput<'_>, lattice: &Lattice) -> Vec<ShapeRecord> {
    let record = |((item, &rank), &paint_or_image): ((&Placed, &u32), &u32)| {
        let segments = item.outline.segments().count();
        let layer = input.layer_of_rank[rank as usize];
        let (coverage, layer_or_image, paint) = match &item.kind {
            PlacedKind::Shape { verdict, .. } => match verdict.coverage {
                Coverage::Msdf => (COVERAGE_MSDF, layer, paint_or_image),
                Coverage::Curves => (COVERAGE_CURVES, layer, paint_or_image),
            },
            PlacedKind::Patch => (COVERAGE_IMAGE, paint_or_image, 0),
            PlacedKind::Clip => return None,
        };
        Some(ShapeRecord {
            coverage,
            fill_rule: match item.rule {
                FillRule::NonZero => FILL_NON_ZERO,
                FillRule::EvenOdd => FILL_EVEN_ODD,
            },
            layer_or_image,
            paint,
            bounds_uv: if segments == 0 {
                [0.0; 4]
            } else {
                bounds_uv(item.outline.bounding_box(), lattice)
            },
            segment_count: u32::try_from(segments).unwrap_or(u32::MAX),
            reserved: 0,
        })
    };
    let items = input.placed.iter().zip(&input.packing.ranks);
    items.zip(input.paint_or_image).filter_map(record).collect()
}

fn bounds_uv(area: Rect, lattice: &Lattice) -> [f32; 4] {
    let canvas = lattice.canvas;
    let u = |x: f64| to_f32((x - canvas.x0) / canvas.width());
    let v = |y: f64| to_f32((y - canvas.y0) / canvas.height());
    [u(area.x0), v(area.y0), u(area.x1), v(area.y1)]
}

/// Warnings of the drawing and of what happened since.
pub(crate) fn warnings(
    drawing: &mut Drawing,
    placed: &[Placed],
    packing: &Packing,
    lists: &CellLists,
) -> Vec<Warning> {
    let mut warnings = std::mem::take(&mut drawing.warnings);
    let canvas =
        Rect::from_origin_size((0.0, 0.0), (drawing.canvas_size[0], drawing.canvas_size[1]));
    for (item, placed) in drawing.items.iter().zip(placed) {
        if let (Item::Shape(shape), PlacedKind::Shape { note, verdict, .. }) = (item, &placed.kind)
            && *note == Note::Failed
            && verdict.coverage == Coverage::Msdf
        {
            warnings.push(Warning {
                code: WarningCode::PathFallback,
                feature: "path".into(),
                element: shape.element.clone(),
                message: "overlaps in this outline could not be removed; its edges may be rough"
                    .into(),
                area: share(shape.outline.bounding_box(), canvas),
            });
        }
    }
    if packing.forced {
        warnings.push(Warning {
            code: WarningCode::MergeOverlap,
            feature: "merge".into(),
            element: String::new(),
            message: "shapes that touch were forced into one layer".into(),
            area: 0.0,
        });
    }
    let told = |code| warnings.iter().any(|warning| warning.code == code);
    let empty = lists.words.iter().all(|&word| word == 0);
    if empty && !told(WarningCode::EmptyDrawing) {
        warnings.push(Warning {
            code: WarningCode::EmptyDrawing,
            feature: "svg".into(),
            element: String::new(),
            message: "nothing in the drawing shows on its canvas".into(),
            area: 0.0,
        });
    }
    warnings
}

/// Share of the canvas that a box covers.
fn share(of: Rect, canvas: Rect) -> f32 {
    let shown = of.intersect(canvas);
    to_f32(shown.area() / canvas.area()).clamp(0.0, 1.0)
}

/// A place for the canvas' mips, if there will be any, and the patches.
pub(crate) fn images(drawing: Drawing, mips: bool) -> Vec<Image> {
    let patches = drawing.items.into_iter().filter_map(|item| match item {
        Item::Patch(patch) => Some(patch.image),
        Item::Shape(_) | Item::Clip(_) => None,
    });
    let mips = mips.then(canvas::no_mips);
    mips.into_iter().chain(patches).collect()
}

/// Where the file comes from.
pub(crate) fn provenance(
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

/// `None` of what is not painted.
fn report((item, placed): (&Item, &Placed)) -> Option<ShapeReport> {
    let (element, source) = match item {
        Item::Shape(shape) => {
            let source = match shape.source {
                ShapeSource::Fill => "fill",
                ShapeSource::Stroke => "stroke",
            };
            (&shape.element, source)
        }
        Item::Patch(patch) => (&patch.element, patch.feature.as_str()),
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
                Coverage::Msdf => size_texels(placed),
                Coverage::Curves => verdict.size_texels,
            },
            field_error: verdict.error,
            ..report
        }),
        PlacedKind::Patch => Some(ShapeReport {
            finding: match item {
                Item::Patch(patch) if patch.feature == SHAPE_FEATURE => Finding::TooManySegments,
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

/// Every option by the name the command line gives it, sorted.
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
    options.sort();
    options
}
