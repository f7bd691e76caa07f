//! Filling the file's records from the results of all stages.

use std::collections::BTreeMap;
use std::sync::Arc;

use kurbo::{Rect, Shape as _};
use vtex_format::{
    COVERAGE_CURVES, COVERAGE_IMAGE, COVERAGE_MSDF, CurveLattice, DistanceOutline, FILL_EVEN_ODD,
    FILL_NON_ZERO, Features, Image, LayerRecord, Meta, SamplerSettings, ShapeRecord, SpecKey,
    VtexFile,
};
use vtex_shaders::shader_blob;

use super::warnings::warnings;
use super::{layout::Layout, provenance::provenance};
use crate::{
    cells::{CellInput, CellLists, paint_table::PaintTable, stored_outlines::stored_curves},
    config::BakeConfig,
    coverage::{
        grid::Lattice,
        placed::{Placed, PlacedKind},
        scales::Scales,
        verdict::Coverage,
    },
    drawing::{Drawing, FillRule, Item, Paint},
    error::BakeError,
    number::to_f32,
    raster::canvas,
};

/// Results of the stages.
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
    /// One for each layer.
    pub(super) layers: Vec<LayerRecord>,
    /// The paints that lists name.
    pub(super) paints: PaintTable,
}

/// The file without mips. With `has_mips` image 0 is a placeholder for them.
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
        mut paints,
        ..
    } = stages;
    let (lattice, scales) = (&layout.lattice, &layout.scales);
    let outline = config.outline_texels.map(|width_texels| DistanceOutline {
        width_texels,
        paint: paints.intern(&config.stroke_color.map_or(Paint::BLACK, Paint::Solid)),
    });
    let warnings = warnings(&mut drawing, input, &lists);
    let (curve_lattice, outlines) = stored_curves(input, &lists, lattice, scales);
    let meta = meta(&drawing, config, lattice, curve_lattice, scales, outline);
    let (paints, gradients) = paints.into_records();
    let provenance = provenance(&drawing, input.placed, config, source_hash, warnings);
    let mut file = VtexFile {
        paints,
        gradients,
        shapes: shape_records(input, lattice),
        layers: stages.layers,
        cells: lists.words,
        entries: lists.entries,
        tiles: stages.tiles,
        curves: lists.curves,
        outlines,
        provenance: Some(provenance),
        images: images(drawing, has_mips),
        ..VtexFile::blank(meta)
    };
    if has_mips {
        file.spec.features |= Features::MIPS;
    }
    file.spec = SpecKey::for_file(&file);
    let shader = shader_blob(&file.spec);
    file.shader = shader.map_err(|error| BakeError::Shader(error.to_string()))?;
    Ok(file)
}

/// The record of the file as a whole.
fn meta(
    drawing: &Drawing,
    config: &BakeConfig,
    lattice: &Lattice,
    curve_lattice: Option<CurveLattice>,
    scales: &Scales,
    outline: Option<DistanceOutline>,
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

/// One record for each item that paints.
fn shape_records(input: &CellInput<'_>, lattice: &Lattice) -> Vec<ShapeRecord> {
    let record = |((item, &rank), &paint_or_image): ((&Placed, &u32), &u32)| {
        let segments = item.outline.segments().count();
        let layer = input.layer_of_rank[rank as usize];
        let (coverage, layer_or_image, paint) = match &item.kind {
            PlacedKind::Shape { verdict, .. } => match verdict.coverage {
                Coverage::Msdf => (COVERAGE_MSDF, layer, paint_or_image),
                Coverage::Curves => (COVERAGE_CURVES, layer, paint_or_image),
            },
            PlacedKind::Image => (COVERAGE_IMAGE, paint_or_image, 0),
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
            // An outline that preparation has emptied has no box.
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

/// The file's images: a placeholder for mips, if there will be any, and those of the drawing.
fn images(drawing: Drawing, mips: bool) -> Vec<Image> {
    let images = drawing.items.into_iter().filter_map(|item| match item {
        Item::Image(item) => Some(item.image),
        Item::Shape(_) | Item::Clip(_) => None,
    });
    let mips = mips.then(canvas::no_mips);
    let mut images: Vec<Image> = mips.into_iter().chain(images).collect();
    share_texels(&mut images);
    images
}

/// Gives images of equal texels the same ones, such as an image that the SVG shows twice.
fn share_texels(images: &mut [Image]) {
    let mut known = BTreeMap::new();
    for image in images {
        let content = (image.size, Arc::clone(&image.mips));
        image.mips = Arc::clone(
            known
                .entry(content)
                .or_insert_with(|| Arc::clone(&image.mips)),
        );
    }
}
