//! The stages of a bake in order, from SVG bytes to the file.

mod draw;
mod fallback;
mod layout;
mod provenance;
mod raster_mode;
mod records;
#[cfg(test)]
mod tests;

use vtex_format::VtexFile;

use crate::{
    cells::{
        CellInput, build_cells,
        layers::Layers,
        packing::pack_items,
        paint_table::{PaintTable, number_paints},
        tiles::render_tiles,
    },
    config::{BakeConfig, Mode, Resources, Stage},
    drawing::Drawing,
    error::BakeError,
    raster::canvas,
};
use layout::lay_out;
use records::Stages;

pub(crate) use draw::draw;
pub(crate) use raster_mode::rastered;

/// Bakes `svg`, the bytes of an SVG or gzipped SVG. What was approximated or left out stands in
/// the warnings of the file's provenance.
///
/// # Errors
/// [`BakeError::Svg`] for bytes that are no SVG with an area, [`BakeError::Parameter`] for an
/// option out of its range, [`BakeError::Limit`] for a drawing beyond a budget.
pub fn bake(svg: &[u8], config: &BakeConfig, resources: &Resources) -> Result<VtexFile, BakeError> {
    bake_observed(svg, config, resources, &|_| ())
}

/// As [`bake`]; `observer` is told each [`Stage`] as it begins, for progress and timing.
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
    let layout = lay_out(&mut drawing, config);
    let (lattice, scales) = (&layout.lattice, &layout.scales);

    observer(Stage::Pack);
    let packing = pack_items(&layout.placed, lattice, scales, config.merge);

    observer(Stage::Cells);
    let tree = std::mem::take(&mut drawing.tree);
    let mut paints = PaintTable::default();
    let first_patch = u32::from(mip0.is_some());
    let paint_or_image = number_paints(&layout.placed, first_patch, &mut paints);
    let layers = Layers::new(&layout.placed, &packing);
    let input = CellInput {
        placed: &layout.placed,
        covers: &layout.covers,
        paint_or_image: &paint_or_image,
        packing: &packing,
        layer_of_rank: &layers.of_rank,
        tree: &tree,
    };
    let lists = build_cells(&input, lattice, &mut paints)?;

    observer(Stage::Msdf);
    let tiles = render_tiles(&input, &lists.tiles, lattice, scales)?;

    observer(Stage::Encode);
    let stages = Stages {
        layout: &layout,
        input: &input,
        layers: layers.records(&lists),
        lists,
        tiles,
        paints,
    };
    let mut file = records::file(drawing, stages, config, source_hash, mip0.is_some())?;

    if let Some(size) = mip0 {
        observer(Stage::Mips);
        canvas::add_mips(&mut file, size, config.mode);
    }
    Ok(file)
}
