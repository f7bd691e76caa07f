//! What cells of a see-through texture tell without a lookup: that nothing is there, or that it is opaque.

use vtex_format::{AddressMode, CellWord, Entry, EntryKind, VtexFile};

use crate::LoadOptions;

/// See `shaders/wgsl/trace/world/cutout.wgsl`.
const MIXED: u8 = 0;
const OPAQUE: u8 = 1;
const EMPTY: u8 = 2;
const CELLS_PER_GROUP: usize = 64;

/// Most columns and rows of the cells of a raster: 64 KiB of classes.
const MAX_RASTER_CELLS: u32 = 512;

/// A texture's cells, and how uv leads to them.
#[derive(Clone, Debug)]
pub(in crate::tracer) struct Cutout {
    size: [u32; 2],
    scale: [f32; 2],
    offset: [f32; 2],
    matrix: [f32; 6],
    address: [AddressMode; 2],
    classes: Vec<u8>,
}

impl Cutout {
    /// `None` where nothing can be told.
    pub(in crate::tracer) fn new(file: &VtexFile, options: &LoadOptions) -> Option<Self> {
        let sampler = &file.meta.sampler;
        let address = options.pack.address.unwrap_or(sampler.address);
        let grid = &file.meta.grid;
        let mut made = Self {
            size: grid.size_cells,
            scale: grid.cell_from_uv_scale,
            offset: grid.cell_from_uv_offset,
            matrix: options
                .pack
                .texture_matrix
                .unwrap_or(sampler.texture_matrix),
            address,
            classes: Vec::new(),
        };
        if is_raster(file) {
            let (size, classes) = raster(file, address)?;
            (made.size, made.classes) = (size, classes);
            (made.scale, made.offset) = (size.map(|side| side as f32), [0.0; 2]);
        } else {
            made.classes = file.cells.iter().map(|&word| of_cell(file, word)).collect();
        }
        let fits = made.size.map(|side| side as usize);
        (fits[0].checked_mul(fits[1]) == Some(made.classes.len())
            && made.classes.iter().any(|&class| class != MIXED))
        .then_some(made)
    }

    /// Groups of four words for the device.
    pub(in crate::tracer) fn groups(&self) -> Vec<[u32; 4]> {
        let bits = |floats: [f32; 4]| floats.map(f32::to_bits);
        let [columns, rows] = self.size;
        let [u, v] = self.address.map(|mode| mode as u32);
        let [a, b, c, d, e, f] = self.matrix;
        let [x, y] = self.scale;
        let [left, top] = self.offset;
        let mut groups = vec![
            [columns, rows, u, v],
            bits([a, b, c, d]),
            bits([e, f, 0.0, 0.0]),
            bits([x, y, left, top]),
        ];
        groups.extend(self.classes.chunks(CELLS_PER_GROUP).map(|cells| {
            let mut words = [0; 4];
            for (index, &class) in cells.iter().enumerate() {
                words[index / 16] |= u32::from(class) << (2 * (index % 16));
            }
            words
        }));
        groups
    }
}

/// Whether a file is one image and nothing else.
fn is_raster(file: &VtexFile) -> bool {
    let whole = |image: &vtex_format::Image| image.rect_uv == [0.0, 0.0, 1.0, 1.0];
    let entry = file
        .entries
        .first_chunk::<2>()
        .copied()
        .and_then(Entry::decode);
    let is_image = entry.is_some_and(|e| e.kind == EntryKind::Image && e.index == 0 && e.last);
    file.cells.len() == 1 && is_image && file.images.first().is_some_and(whole)
}

/// The class of a cell of the file.
fn of_cell(file: &VtexFile, word: u32) -> u8 {
    match CellWord::decode(word) {
        Some(CellWord::Empty) => EMPTY,
        Some(CellWord::Paint { paint }) => {
            let paint = file.paints.get(paint as usize);
            match paint.is_some_and(vtex_format::PaintRecord::is_opaque) {
                true => OPAQUE,
                false => MIXED,
            }
        }
        Some(CellWord::List { offset_words }) => {
            let words = file
                .entries
                .get(offset_words as usize..)
                .unwrap_or_default();
            of_list(words)
        }
        None => MIXED,
    }
}

/// Opaque where some entry covers all of the cell and hides what lies behind, and no clip or group says
/// otherwise.
fn of_list(words: &[u32]) -> u8 {
    let mut class = MIXED;
    for &entry in words.as_chunks::<2>().0 {
        let Some(entry) = Entry::decode(entry) else {
            return MIXED;
        };
        if !entry.kind.draws() {
            return MIXED;
        }
        if entry.kind == EntryKind::Full && entry.opaque {
            class = OPAQUE;
        }
        if entry.last {
            return class;
        }
    }
    MIXED
}

/// Cells of an image, by the alpha of the texels that a bilinear lookup in each may read.
fn raster(file: &VtexFile, address: [AddressMode; 2]) -> Option<([u32; 2], Vec<u8>)> {
    let image = file.images.first()?;
    let [width, height] = image.size;
    let texels = image.mips.first()?.as_chunks::<4>().0;
    if texels.len() != width as usize * height as usize {
        return None;
    }
    let size = image.size.map(|side| side.min(MAX_RASTER_CELLS));
    // Texels of a cell, and one beside them, along one axis.
    let reach = |cell: u32, axis: usize| {
        let side = i64::from(image.size[axis]);
        let [first, end] = [cell, cell + 1].map(|at| i64::from(at) * side / i64::from(size[axis]));
        (first - 1..=end + 1).map(move |texel| match address[axis] {
            AddressMode::Repeat => texel.rem_euclid(side),
            _ => texel.clamp(0, side - 1),
        })
    };
    let columns: Vec<Vec<usize>> = (0..size[0])
        .map(|cell| {
            reach(cell, 0)
                .filter_map(|x| usize::try_from(x).ok())
                .collect()
        })
        .collect();
    let mut classes = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for row in 0..size[1] {
        let rows: Vec<usize> = reach(row, 1)
            .filter_map(|y| usize::try_from(y).ok())
            .collect();
        for columns in &columns {
            let alphas = || {
                let row = |y: usize| {
                    columns
                        .iter()
                        .map(move |x| texels[y * width as usize + x][3])
                };
                rows.iter().flat_map(move |&y| row(y))
            };
            classes.push(if alphas().all(|alpha| alpha == u8::MAX) {
                OPAQUE
            } else if alphas().all(|alpha| alpha == 0) {
                EMPTY
            } else {
                MIXED
            });
        }
    }
    Some((size, classes))
}
