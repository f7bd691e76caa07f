//! From the drawing to the file: runs the stages in order and fills the records.

mod records;
#[cfg(test)]
mod tests;

use kurbo::Shape as _;
use rayon::prelude::*;
use vtex_format::{
    CurveLattice, CurveSources, LayerRecord, Outline, ShaderBlob, SpecKey, VtexFile,
};

use vtex_shaders::{SpecParts, shader_blob, spec_key_from_parts};

use crate::{
    cells::{
        CellInput, CellLists, build_cells,
        packing::{Packing, merge_all, pack},
        paint_table::PaintTable,
        sources::sources,
    },
    config::{BakeConfig, Mode, Stage},
    coverage::{
        cover::{Cover, cover, curve_lattice, flatness_units, patch_failures},
        curves::CurveError,
        grid::Lattice,
        judge::{Judgement, Verdict, all_curves, judge},
        msdf::{TileShape, TileSpec, render_tile},
        placed::{Placed, PlacedKind, place},
        scales::Scales,
    },
    drawing::{Drawing, Item, Paint, tree::Tree},
    error::BakeError,
    raster::{
        canvas,
        patch::{PatchSettings, whole_canvas},
    },
};

/// Bytes of MSDF tiles in a file; beyond, a smaller lattice serves better and most GPUs refuse
/// the buffer.
const MAX_TILE_BYTES: usize = 1 << 30;

/// Pieces of outlines in cells beyond which no finer grid is tried: 200 MiB of them.
const MAX_PIECES: f64 = 2e6;

/// Everything between the drawing and the bytes. Pure; the same at any thread count. `mip0` is the
/// size of the canvas' mip chain in texels, `None` for a file without.
pub(crate) fn assemble(
    mut drawing: Drawing,
    mip0: Option<[u32; 2]>,
    config: &BakeConfig,
    source_hash: [u8; 32],
    observer: &(dyn Fn(Stage) + Sync),
) -> Result<VtexFile, BakeError> {
    observer(Stage::Prepare);
    let Judgement {
        verdicts,
        msdf_size,
    } = judge(&drawing, config, config.mip0_size);
    let Laid {
        lattice,
        scales,
        mut placed,
        covers,
    } = lay(&drawing, &verdicts, config, msdf_size);
    let settings = PatchSettings::new(drawing.canvas_size, config);
    let covers = patch_failures(covers, &mut drawing, &mut placed, &lattice, settings);

    observer(Stage::Pack);
    let packing = pack_items(&placed, &lattice, &scales, config.merge);

    observer(Stage::Cells);
    let tree = std::mem::take(&mut drawing.tree);
    let mut paints = PaintTable::default();
    let first_patch = u32::from(mip0.is_some());
    let paint_or_image = number_paints(&placed, first_patch, &mut paints);
    let layers = Layers::new(&placed, &packing);
    let input = CellInput {
        placed: &placed,
        covers: &covers,
        paint_or_image: &paint_or_image,
        packing: &packing,
        layer_of_rank: &layers.of_rank,
        tree: &tree,
    };
    let lists = build_cells(&input, &lattice, &mut paints)?;

    observer(Stage::Msdf);
    let tiles = render_tiles(&input, &lists, &lattice, &scales)?;

    observer(Stage::Encode);
    let outline = config.outline_texels.map(|width_texels| Outline {
        width_texels,
        paint: paints.intern(&config.stroke_color.map_or(Paint::BLACK, Paint::Solid)),
    });
    let warnings = records::warnings(&mut drawing, &placed, &packing, &lists);
    let (curve_lattice, sources) = stored_curves(&input, &lists, &lattice, &scales, config);
    let meta = records::meta(&drawing, config, &lattice, curve_lattice, &scales, outline);
    let shapes = records::shape_records(&input, &lattice);
    let layers = layers.records(&lists);
    let (paints, gradients) = paints.into_records();
    let (spec, shader) = specialised(&SpecParts {
        sampler: &meta.sampler,
        texels_per_cell: lattice.grid.texels_per_cell,
        paints: &paints,
        cells: &lists.words,
        entries: &lists.entries,
        canvas_mips: mip0.is_some(),
    })?;
    let mut file = VtexFile {
        meta,
        spec,
        shader,
        paints,
        gradients,
        shapes,
        layers,
        cells: lists.words,
        entries: lists.entries,
        tiles,
        curves: lists.curves,
        sources,
        provenance: Some(records::provenance(
            &drawing,
            &placed,
            config,
            source_hash,
            warnings,
        )),
        images: records::images(drawing, mip0.is_some()),
    };
    if let Some(size) = mip0 {
        observer(Stage::Mips);
        canvas::add_mips(&mut file, size, config.mode);
    }
    Ok(file)
}

/// The drawing as one raster of what its shapes show.
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
        items: vec![Item::Patch(patch)],
        tree: Tree::flat(1),
        warnings,
    })
}

/// The shader's key and text.
fn specialised(parts: &SpecParts<'_>) -> Result<(SpecKey, ShaderBlob), BakeError> {
    let spec = spec_key_from_parts(parts);
    let shader = shader_blob(&spec).map_err(|error| BakeError::Shader(error.to_string()))?;
    Ok((spec, shader))
}

/// The lattice of curve records, if there are any, and the outlines that they are made from.
fn stored_curves(
    input: &CellInput<'_>,
    lists: &CellLists,
    lattice: &Lattice,
    scales: &Scales,
    config: &BakeConfig,
) -> (Option<CurveLattice>, Option<CurveSources>) {
    let curve_lattice = curve_lattice(input.placed, lattice, scales, config.max_zoom)
        .filter(|_| !lists.curves.is_empty());
    let sources = curve_lattice
        .and_then(|curves| stored_outlines(input, lists, lattice, curves, config.max_zoom));
    (curve_lattice, sources)
}

/// The outlines that a reader makes the curve records from, where it can.
fn stored_outlines(
    input: &CellInput<'_>,
    lists: &CellLists,
    lattice: &Lattice,
    curve_lattice: CurveLattice,
    max_zoom: f32,
) -> Option<CurveSources> {
    let flatness = flatness_units(lattice, curve_lattice, max_zoom);
    sources(input.covers, &lists.sources, flatness)
        .filter(|sources| sources.is_cuttable(&lattice.grid, curve_lattice))
}

/// About how many pieces the cells of a lattice cut outlines into, which are placed on another.
fn pieces(placed: &[Placed], lattice: &Lattice) -> f64 {
    let shapes = placed.iter().filter(|item| item.kind != PlacedKind::Patch);
    let segments = shapes.flat_map(|item| item.outline.segments());
    let reach: f64 = segments
        .map(|segment| {
            let bounds = segment.bounding_box();
            (bounds.width() + bounds.height()) / lattice.longer_steps()
        })
        .sum();
    reach * f64::from(lattice.grid.size_cells[0].max(lattice.grid.size_cells[1]))
}

/// A drawing on its grid.
struct Laid {
    lattice: Lattice,
    scales: Scales,
    placed: Vec<Placed>,
    covers: Vec<Result<Cover, CurveError>>,
}

/// Lays the drawing on the coarsest grid whose cells have room for its outlines.
fn lay(drawing: &Drawing, verdicts: &[Verdict], config: &BakeConfig, msdf_size: u32) -> Laid {
    let mip0_size = config.mip0_size;
    let on = |lattice: Lattice| {
        let scales = Scales::new(config, &lattice, mip0_size);
        let placed = place(drawing, &lattice, verdicts);
        let covers = cover(&placed, &lattice, &scales, config.max_zoom);
        Laid {
            lattice,
            scales,
            placed,
            covers,
        }
    };
    if !all_curves(drawing, verdicts) {
        return on(Lattice::new(drawing.canvas_size, msdf_size));
    }
    let mut laid = on(Lattice::for_curves(
        drawing.canvas_size,
        msdf_size,
        mip0_size,
    ));
    // What is too much for a cell may not be for its parts.
    while laid.covers.iter().any(Result::is_err) {
        let halved = laid.lattice.halved(drawing.canvas_size, mip0_size);
        let Some(halved) = halved.filter(|halved| pieces(&laid.placed, halved) <= MAX_PIECES)
        else {
            break;
        };
        laid = on(halved);
    }
    laid
}

fn pack_items(placed: &[Placed], lattice: &Lattice, scales: &Scales, merge: bool) -> Packing {
    // Two shapes in a tile must keep out of each other's distances, two in a curve record only
    // out of each other's ramps.
    let shapes = || placed.iter().filter(|item| item.is_shape());
    let reach = if shapes().all(Placed::is_curves) {
        2.0 * scales.distances.margin
    } else {
        scales.range
    };
    let window = lattice.canvas.inflate(reach, reach);
    if merge {
        merge_all(placed, window, reach)
    } else {
        pack(placed, window, reach)
    }
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
        .map(|item| match &item.kind {
            PlacedKind::Shape { paint, .. } => paints.intern(paint),
            PlacedKind::Patch => patches.next().unwrap_or(u32::MAX),
            PlacedKind::Clip => 0,
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
                        let cells = &input.covers[item as usize].cells;
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
