//! The file's records: what the bake decided, as the format stores it.

use kurbo::{Rect, Shape as _};
use vtex_format::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, CurveLattice, FILL_EVEN_ODD, FILL_NON_ZERO,
    Features, Image, LayerRecord, Meta, Outline, SamplerSettings, ShaderBlob, ShapeRecord, SpecKey,
    VtexFile, Warning, WarningCode,
};
use vtex_shaders::shader_blob;

use super::{layout::Layout, provenance::provenance};
use crate::{
    cells::{
        CellInput, CellLists, packing::Packing, paint_table::PaintTable, sources::stored_curves,
    },
    config::BakeConfig,
    coverage::{
        grid::Lattice,
        placed::{Placed, PlacedKind},
        scales::Scales,
        verdict::Coverage,
    },
    drawing::{Drawing, FillRule, Item, Paint},
    error::BakeError,
    geometry::prepare::Note,
    number::to_f32,
    raster::canvas,
};

/// What the stages before have made.
#[derive(Debug)]
pub(super) struct Stages<'a> {
    /// The drawing and its grid.
    pub(super) layout: &'a Layout,
    /// What the cells' lists were made from.
    pub(super) input: &'a CellInput<'a>,
    /// The lists.
    pub(super) lists: CellLists,
    /// Texels of the lists' tiles.
    pub(super) tiles: Vec<u8>,
    /// One a layer.
    pub(super) layers: Vec<LayerRecord>,
    /// The paints that lists name.
    pub(super) paints: PaintTable,
}

/// The file, its mips apart: with `has_mips` image 0 is kept free for them.
pub(super) fn file(
    mut drawing: Drawing,
    stages: Stages<'_>,
    config: &BakeConfig,
    source_hash: [u8; 32],
    has_mips: bool,
) -> Result<VtexFile, BakeError> {
    let Stages {
        layout,
        input,
        lists,
        tiles,
        layers,
        mut paints,
    } = stages;
    let Layout {
        lattice,
        scales,
        placed,
        ..
    } = layout;
    let outline = config.outline_texels.map(|width_texels| Outline {
        width_texels,
        paint: paints.intern(&config.stroke_color.map_or(Paint::BLACK, Paint::Solid)),
    });
    let warnings = warnings(&mut drawing, placed, input.packing, &lists);
    let (curve_lattice, sources) = stored_curves(input, &lists, lattice, scales);
    let meta = meta(&drawing, config, lattice, curve_lattice, scales, outline);
    let (paints, gradients) = paints.into_records();
    let features = if has_mips { Features::MIPS } else { 0 };
    specialised(VtexFile {
        meta,
        spec: SpecKey {
            features,
            ..SpecKey::default()
        },
        shader: ShaderBlob::default(),
        paints,
        gradients,
        shapes: shape_records(input, lattice),
        layers,
        cells: lists.words,
        entries: lists.entries,
        tiles,
        curves: lists.curves,
        sources,
        provenance: Some(provenance(&drawing, placed, config, source_hash, warnings)),
        images: images(drawing, has_mips),
    })
}

/// The file with the key and the text of its shader.
fn specialised(mut file: VtexFile) -> Result<VtexFile, BakeError> {
    file.spec = SpecKey::for_file(&file);
    let blob = shader_blob(&file.spec);
    file.shader = blob.map_err(|error| BakeError::Shader(error.to_string()))?;
    Ok(file)
}

/// The file's general record.
fn meta(
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
fn shape_records(input: &CellInput<'_>, lattice: &Lattice) -> Vec<ShapeRecord> {
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
fn warnings(
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
fn images(drawing: Drawing, mips: bool) -> Vec<Image> {
    let patches = drawing.items.into_iter().filter_map(|item| match item {
        Item::Patch(patch) => Some(patch.image),
        Item::Shape(_) | Item::Clip(_) => None,
    });
    let mips = mips.then(canvas::no_mips);
    mips.into_iter().chain(patches).collect()
}
