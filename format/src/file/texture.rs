//! A whole file as a value.

use super::spec::{SHADER_ABI, SpecKey};
use crate::cells::cell::{CellWord, Entry, EntryKind};
use crate::curves::outlines::StoredOutlines;
use crate::records::image::Image;
use crate::records::layer::LayerRecord;
use crate::records::meta::{Grid, Meta};
use crate::records::paint::PaintRecord;
use crate::records::prov::Provenance;
use crate::records::shader::ShaderBlob;
use crate::records::shape::ShapeRecord;

/// One vector texture, read and checked or about to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct VtexFile {
    /// Canvas, grid and sampler settings.
    pub meta: Meta,
    /// Key of the specialised shader.
    pub spec: SpecKey,
    /// The specialised shader.
    pub shader: ShaderBlob,
    /// Paints, deduplicated.
    pub paints: Vec<PaintRecord>,
    /// The numbers of gradients, paint by paint: [`crate::Gradient`].
    pub gradients: Vec<f32>,
    /// Shapes in painter's order.
    pub shapes: Vec<ShapeRecord>,
    /// Layers, back to front.
    pub layers: Vec<LayerRecord>,
    /// One word a cell, row by row from the top: [`crate::CellWord`].
    pub cells: Vec<u32>,
    /// The cells' lists: [`crate::Entry`].
    pub entries: Vec<u32>,
    /// Curve records one after the other: [`crate::CurveHeader`].
    pub curves: Vec<u32>,
    /// What `curves` is made from; a file then holds it instead of them, which takes a fraction of
    /// the bytes.
    pub outlines: Option<StoredOutlines>,
    /// What packing makes of cells, lists and curves for one filter mode, so that a loader need not: its
    /// ABI, then words that the packer of this ABI knows. Empty when the section was left out.
    pub fine: Vec<u32>,
    /// MSDF tiles, layer by layer: [`LayerRecord`].
    pub tiles: Vec<u8>,
    /// Raster images; with [`crate::Features::MIPS`] the first is the canvas itself.
    pub images: Vec<Image>,
    /// How it was baked; `None` when the section was left out.
    pub provenance: Option<Provenance>,
}

impl VtexFile {
    /// A file whose cells are all empty, and without anything else: what others are made from, as
    /// in `VtexFile { paints, cells, ..VtexFile::blank(meta) }`.
    ///
    /// The key is that of the blank file and the shader has no text; [`SpecKey::for_file`] makes
    /// the key of what the file becomes.
    pub fn blank(meta: Meta) -> Self {
        let [columns, rows] = meta.grid.size_cells.map(|side| side as usize);
        // An empty cell's word is zero.
        let cells = vec![0; columns.saturating_mul(rows)];
        let mut file = Self {
            meta,
            spec: SpecKey::default(),
            shader: ShaderBlob {
                abi: SHADER_ABI,
                wgsl_fragment: String::new(),
                batch_spirv: Vec::new(),
            },
            paints: Vec::new(),
            gradients: Vec::new(),
            shapes: Vec::new(),
            layers: Vec::new(),
            cells,
            entries: Vec::new(),
            curves: Vec::new(),
            outlines: None,
            fine: Vec::new(),
            tiles: Vec::new(),
            images: Vec::new(),
            provenance: None,
        };
        file.spec = SpecKey::for_file(&file);
        file
    }
    /// A file of one cell that shows one image, which is also the canvas image where the key has mips.
    /// `opaque`: whether all of its texels are.
    ///
    /// The grid is one of a single cell, square in user units; that of `meta` gives the texels along it.
    pub fn of_image(mut meta: Meta, image: Image, opaque: bool) -> Self {
        let [width, height] = meta.canvas_size;
        meta.grid = Grid {
            size_cells: [1, 1],
            cell_from_uv_scale: [width, height].map(|side| side / width.max(height)),
            cell_from_uv_offset: [0.0, 0.0],
            ..meta.grid
        };
        let entry = Entry {
            kind: EntryKind::Image,
            last: true,
            opaque,
            index: 0,
            data: 0,
        };
        let cell = CellWord::List { offset_words: 0 };
        let mut file = Self {
            cells: cell.encode().into_iter().collect(),
            entries: entry.encode().into_iter().flatten().collect(),
            images: vec![image],
            ..Self::blank(meta)
        };
        file.spec = SpecKey::for_file(&file);
        file
    }
}
