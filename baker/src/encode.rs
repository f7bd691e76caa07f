//! From the drawing to the file: runs the stages in order and fills the records.

use kurbo::{Rect, Shape as _};
use rayon::prelude::*;
use vtex_format::{
    COVERAGE_IMAGE, COVERAGE_MSDF, FILL_EVEN_ODD, FILL_NON_ZERO, Image, LayerRecord, Meta, Outline,
    Provenance, SamplerSettings, ShapeRecord, ShapeReport, VtexFile, Warning, WarningCode,
};

use vtex_shaders::{SpecParts, shader_blob, spec_key_from_parts};

use crate::{
    cells::{CellInput, CellLists, build_cells},
    classify::{Distances, ShapeCells, classify},
    config::{BakeConfig, Stage},
    drawing::{Drawing, FillRule, Item, ShapeSource},
    error::BakeError,
    grid::Lattice,
    msdf::{TileShape, TileSpec, render_tile},
    paint_table::PaintTable,
    placed::{Placed, PlacedKind, place},
    prepare::Note,
    subset::{Packing, merge_all, pack},
};

/// Bytes of MSDF tiles in a file; beyond, a smaller lattice serves better and most GPUs refuse
/// the buffer.
const MAX_TILE_BYTES: usize = 1 << 30;
/// Steps beyond half the range within which an edge still takes part in a tile: bilinear lookups
/// near an edge mix texels that lie up to a diagonal further off.
const REACH_BEYOND_RANGE: f64 = 1.5;
/// Steps by which evaluators' f32 arithmetic may misplace a lookup, with room to spare.
const ROUNDING_MARGIN: f64 = 0.01;

/// Everything between the drawing and the bytes. Pure; the same at any thread count.
pub(crate) fn assemble(
    mut drawing: Drawing,
    mips: Option<Image>,
    config: &BakeConfig,
    source_hash: [u8; 32],
    observer: &(dyn Fn(Stage) + Sync),
) -> Result<VtexFile, BakeError> {
    let lattice = Lattice::new(drawing.canvas_size, config.msdf_size);
    let scales = Scales::new(config, &lattice, mips.as_ref());

    observer(Stage::Prepare);
    let placed = place(&drawing, &lattice);

    observer(Stage::Pack);
    let window = lattice.canvas.inflate(scales.range, scales.range);
    let packing = if config.merge {
        merge_all(&placed, window, scales.range)
    } else {
        pack(&placed, window, scales.range)
    };

    observer(Stage::Cells);
    let classified: Vec<ShapeCells> = placed
        .par_iter()
        .map(|item| {
            if item.is_shape() {
                classify(item, &lattice, scales.distances)
            } else {
                ShapeCells::default()
            }
        })
        .collect();
    let mut paints = PaintTable::default();
    let first_patch = u32::from(mips.is_some());
    let paint_or_image = number_paints(&placed, first_patch, &mut paints);
    let layers = Layers::new(&placed, &packing);
    let input = CellInput {
        placed: &placed,
        cells: &classified,
        paint_or_image: &paint_or_image,
        packing: &packing,
        layer_of_rank: &layers.of_rank,
    };
    let lists = build_cells(&input, &lattice, &mut paints)?;

    observer(Stage::Msdf);
    let tiles = render_tiles(&input, &lists, &lattice, &scales)?;

    observer(Stage::Encode);
    let outline = config.outline_texels.map(|width_texels| Outline {
        width_texels,
        paint: paints.intern(config.stroke_color.unwrap_or([0.0, 0.0, 0.0, 1.0])),
    });
    let warnings = warnings(&mut drawing, &placed, &packing, &lists);
    let meta = meta(&drawing, config, &lattice, &scales, outline);
    let shapes = shape_records(&input, &lattice);
    let layers = layers.records(&lists);
    let paints = paints.into_records();
    let spec = spec_key_from_parts(&SpecParts {
        sampler: &meta.sampler,
        texels_per_cell: lattice.grid.texels_per_cell,
        paints: &paints,
        cells: &lists.words,
        entries: &lists.entries,
        canvas_mips: mips.is_some(),
    });
    let shader = shader_blob(&spec).map_err(|error| BakeError::Shader(error.to_string()))?;
    Ok(VtexFile {
        meta,
        spec,
        shader,
        paints,
        shapes,
        layers,
        cells: lists.words,
        entries: lists.entries,
        curves: Vec::new(),
        tiles,
        provenance: Some(provenance(&drawing, &placed, config, source_hash, warnings)),
        images: images(drawing, mips),
    })
}

/// Distances of this bake, in steps.
#[derive(Clone, Copy, Debug)]
struct Scales {
    range: f64,
    distances: Distances,
}

impl Scales {
    fn new(config: &BakeConfig, lattice: &Lattice, mips: Option<&Image>) -> Self {
        let mip0 = mips.map_or(config.mip0_size, |image| image.size[0].max(image.size[1]));
        // Cells serve footprints up to a texel of mip 0; the ramp reaches half of one outwards.
        let ramp = 0.5 * lattice.longer_steps() / f64::from(mip0.max(1));
        let outline = f64::from(config.outline_texels.unwrap_or(0.0));
        let needed = 2.0 * (outline + ramp + ROUNDING_MARGIN);
        let range = f64::from(to_f32(needed.max(f64::from(config.distance_range_texels))));
        let smoothing = f64::from(config.smoothing) * range;
        Self {
            range,
            distances: Distances {
                margin: outline + ramp.max(smoothing) + ROUNDING_MARGIN,
                reach: 0.5 * range + REACH_BEYOND_RANGE,
            },
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "stored as f32")]
fn to_f32(x: f64) -> f32 {
    x as f32
}

/// Layers are the ranks that hold shapes.
struct Layers {
    of_rank: Vec<u32>,
    shape_counts: Vec<u32>,
}

impl Layers {
    fn new(placed: &[Placed], packing: &Packing) -> Self {
        let mut shapes_of_rank = vec![0; packing.count as usize];
        for (item, &rank) in placed.iter().zip(&packing.ranks) {
            shapes_of_rank[rank as usize] += u32::from(item.is_shape());
        }
        let mut next = 0;
        let of_rank = shapes_of_rank
            .iter()
            .map(|&shapes| {
                let layer = next;
                next += u32::from(shapes > 0);
                layer
            })
            .collect();
        shapes_of_rank.retain(|&shapes| shapes > 0);
        Self {
            of_rank,
            shape_counts: shapes_of_rank,
        }
    }

    fn records(&self, lists: &CellLists) -> Vec<LayerRecord> {
        let first_of = |layer: u32| {
            let first = lists.tiles.partition_point(|tile| tile.layer < layer);
            u32::try_from(first).unwrap_or(u32::MAX)
        };
        (0..)
            .zip(&self.shape_counts)
            .map(|(layer, &shape_count)| LayerRecord {
                tile_first: first_of(layer),
                tile_count: first_of(layer + 1) - first_of(layer),
                shape_count,
                reserved: 0,
            })
            .collect()
    }
}

fn number_paints(placed: &[Placed], first_patch: u32, paints: &mut PaintTable) -> Vec<u32> {
    let mut patches = first_patch..;
    placed
        .iter()
        .map(|item| match item.kind {
            PlacedKind::Shape { color, .. } => paints.intern(color),
            PlacedKind::Patch => patches.next().unwrap_or(u32::MAX),
        })
        .collect()
}

fn render_tiles(
    input: &CellInput<'_>,
    lists: &CellLists,
    lattice: &Lattice,
    scales: &Scales,
) -> Result<Vec<u8>, BakeError> {
    let side = lattice.grid.texels_per_cell as usize + 1;
    let tile_bytes = 4 * side * side;
    let total = lists.tiles.len().saturating_mul(tile_bytes);
    if total > MAX_TILE_BYTES {
        return Err(BakeError::Limit(format!(
            "{} MiB of distance fields; bake with a smaller MSDF size",
            total >> 20
        )));
    }
    let mut texels = vec![0; total];
    texels
        .par_chunks_exact_mut(tile_bytes)
        .zip(&lists.tiles)
        .for_each(|(texels, draft)| {
            let columns = lattice.grid.size_cells[0];
            let n = lattice.grid.texels_per_cell;
            let spec = TileSpec {
                origin: [draft.cell % columns * n, draft.cell / columns * n],
                steps: n,
                range: scales.range,
                reach: scales.distances.reach,
                shapes: draft
                    .items
                    .iter()
                    .map(|&item| {
                        let cells = &input.cells[item as usize];
                        TileShape {
                            edges: cells.edges_near(draft.cell).collect(),
                            placed: &input.placed[item as usize],
                            rows: &cells.rows,
                        }
                    })
                    .collect(),
            };
            texels.copy_from_slice(&render_tile(&spec));
        });
    Ok(texels)
}

fn meta(
    drawing: &Drawing,
    config: &BakeConfig,
    lattice: &Lattice,
    scales: &Scales,
    outline: Option<Outline>,
) -> Meta {
    Meta {
        canvas_size: drawing.canvas_size.map(to_f32),
        grid: lattice.grid,
        distance_range_texels: to_f32(scales.range),
        max_zoom: config.max_zoom,
        sampler: SamplerSettings {
            texture_matrix: config.texture_matrix,
            address: config.address,
            smoothing: config.smoothing,
            mask: config.mask,
            outline,
        },
        curve_lattice: None,
    }
}

fn shape_records(input: &CellInput<'_>, lattice: &Lattice) -> Vec<ShapeRecord> {
    let record = |((item, &rank), &paint_or_image): ((&Placed, &u32), &u32)| {
        let segments = item.outline.segments().count();
        let layer = input.layer_of_rank[rank as usize];
        let (coverage, layer_or_image, paint) = match item.kind {
            PlacedKind::Shape { .. } => (COVERAGE_MSDF, layer, paint_or_image),
            PlacedKind::Patch => (COVERAGE_IMAGE, paint_or_image, 0),
        };
        ShapeRecord {
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
        }
    };
    let items = input.placed.iter().zip(&input.packing.ranks);
    items.zip(input.paint_or_image).map(record).collect()
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
    for (item, placed) in drawing.items.iter().zip(placed) {
        if let (Item::Shape(shape), PlacedKind::Shape { note, .. }) = (item, placed.kind)
            && note == Note::Fallback
        {
            warnings.push(Warning {
                code: WarningCode::PathFallback,
                feature: "path".into(),
                element: shape.element.clone(),
                message: "overlaps in this outline could not be removed; its edges may be rough"
                    .into(),
            });
        }
    }
    if packing.forced {
        warnings.push(Warning {
            code: WarningCode::MergeOverlap,
            feature: "merge".into(),
            element: String::new(),
            message: "shapes that touch were forced into one layer".into(),
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
        });
    }
    warnings
}

fn images(drawing: Drawing, mips: Option<Image>) -> Vec<Image> {
    let patches = drawing.items.into_iter().filter_map(|item| match item {
        Item::Patch(patch) => Some(patch.image),
        Item::Shape(_) => None,
    });
    mips.into_iter().chain(patches).collect()
}

fn provenance(
    drawing: &Drawing,
    placed: &[Placed],
    config: &BakeConfig,
    source_hash: [u8; 32],
    warnings: Vec<Warning>,
) -> Provenance {
    let report = |(item, placed): (&Item, &Placed)| match item {
        Item::Shape(shape) => ShapeReport {
            element: shape.element.clone(),
            source: match shape.source {
                ShapeSource::Fill => "fill".into(),
                ShapeSource::Stroke => "stroke".into(),
            },
            note: match placed.kind {
                PlacedKind::Shape { note, .. } => note.text().into(),
                PlacedKind::Patch => String::new(),
            },
        },
        Item::Patch(patch) => ShapeReport {
            element: patch.element.clone(),
            source: patch.feature.clone(),
            note: String::new(),
        },
    };
    Provenance {
        source_hash,
        tool: concat!("vtex-baker ", env!("CARGO_PKG_VERSION")).into(),
        options: options(config),
        shapes: drawing.items.iter().zip(placed).map(report).collect(),
        warnings,
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
