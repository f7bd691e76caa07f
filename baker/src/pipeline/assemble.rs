//! The back half: from the drawing to the file.

use vtex_format::VtexFile;
use vtex_shaders::{FilterMode, fine_words};

use super::{
    gpu_budget,
    layout::lay_out,
    records::{self, Stages},
};
use crate::{
    cells::{
        CellInput, build_cells,
        layers::Layers,
        packing::pack_items,
        paint_table::{PaintTable, number_paints},
        tiles::render_tiles,
    },
    config::{BakeConfig, Profile, Stage},
    drawing::Drawing,
    error::BakeError,
    raster::canvas,
};

/// The file of a drawing. `mip0` is the size of mip 0 in texels; `None` makes a file without mips.
///
/// # Errors
/// [`BakeError::Limit`] for a drawing that asks for too much.
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
    // Mips, if there are any, are image 0.
    let first_image = u32::from(mip0.is_some());
    let tree = std::mem::take(&mut drawing.tree);
    let mut paints = PaintTable::default();
    let paint_or_image = number_paints(&layout.placed, first_image, &mut paints);
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
        // Mips are averages of lookups in the finished cells.
        observer(Stage::Mips);
        let words = canvas::add_mips(&mut file, size, config.mode);
        gpu_budget::warn(&mut file, words, config.mode, config.gpu_budget_bytes);
    }
    file.fine = match config.profile {
        Profile::Size => Vec::new(),
        Profile::Load => fine_words(&file, FilterMode::Point),
        Profile::LoadFootprints => fine_words(&file, FilterMode::Footprint),
    };
    Ok(file)
}
