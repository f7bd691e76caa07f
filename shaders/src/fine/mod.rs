//! Fine cells in a file ([`VtexFile::fine`]): written once, so that a loader need not cut outlines.
//!
//! The words are a cache of what [`subdivide`](crate::subdivide) makes. They come from a file, so
//! [`lists`] and [`cells`] look at each of them before it is used. What does not keep the rules is passed
//! over, as are words of another ABI: the file has all that is needed to make them again.

mod cells;
mod lists;

use vtex_format::{Features, Issue, SHADER_ABI, VtexFile};

use crate::layout::FilterMode;
use crate::subdivide::{Grid, subdivide};
use lists::Tables;

/// Words before the cells: ABI, filter mode, the base cells' side, and the number of words of cells.
const HEAD_WORDS: usize = 4;

/// Cells are made for points or for footprints; paper mode has those of points.
const fn filter_number(filter: FilterMode) -> u32 {
    match filter {
        FilterMode::Footprint => FilterMode::Footprint as u32,
        FilterMode::Point | FilterMode::Paper => FilterMode::Point as u32,
    }
}

/// What [`VtexFile::fine`] is to hold so that the file loads fast with this filter mode. A loader that
/// wants another mode, or [`PackOptions::halvings`](crate::PackOptions::halvings), does not use it.
///
/// None for a texture too large to be named by words.
pub fn fine_words(file: &VtexFile, filter: FilterMode) -> Vec<u32> {
    let made = subdivide(file, filter, None);
    let Ok(count) = u32::try_from(made.grid.words.len()) else {
        return Vec::new();
    };
    let side = made.grid.side.cast_unsigned();
    let mut words = vec![SHADER_ABI, filter_number(filter), side, count];
    words.extend(cells::stored(&made.grid.words, &made.commands));
    words.extend(made.commands.as_flattened());
    words
}

/// The issue of a file whose fine cells are not those that packing makes of its lists. Loaders pass over
/// words that lead out of the texture, but words that show another picture they cannot tell.
///
/// None of a file without fine cells of this ABI. Takes as long as packing.
pub fn check_fine(file: &VtexFile) -> Option<Issue> {
    if file.fine.first() != Some(&SHADER_ABI) {
        return None;
    }
    let modes = [FilterMode::Point, FilterMode::Footprint];
    let mut made = modes.into_iter().map(|mode| fine_words(file, mode));
    (!made.any(|words| words == file.fine)).then(Issue::fine_cells)
}

/// The cells that a file holds for this filter mode; `None` where it holds none, or where their words do
/// not keep the rules. `features` are those of the text that reads them.
pub(crate) fn grid(file: &VtexFile, filter: FilterMode, features: u32) -> Option<Grid> {
    let (&[abi, number, side, count], _) = file.fine.split_first_chunk::<HEAD_WORDS>()?;
    if abi != SHADER_ABI || number != filter_number(filter) {
        return None;
    }
    let has_groups = features & Features::GROUPS != 0;
    // Levels are made by the file's own key and looked for by that of the content.
    if has_groups != (file.spec.features & Features::GROUPS != 0) {
        return None;
    }
    let lists = Tables::new(file, features).lists(commands(file))?;
    let stored = file.fine.get(HEAD_WORDS..)?.get(..count as usize)?;
    let shape = cells::Shape {
        side: side.cast_signed(),
        cells: file.meta.grid.size_cells,
        has_levels: filter == FilterMode::Footprint && !has_groups,
        paints: file.paints.len(),
    };
    cells::grid(stored, &lists, &shape)
}

/// The commands that go with [`grid`].
pub(crate) fn commands(file: &VtexFile) -> &[u32] {
    let count = file.fine.get(HEAD_WORDS - 1).copied().unwrap_or(0);
    let first = HEAD_WORDS.saturating_add(count as usize);
    file.fine.get(first..).unwrap_or(&[])
}
