//! The key of a file's specialised shader, from what the file holds.

use vtex_format::{
    AddressMode, CellWord, Entry, EntryKind, Features, Image, MAX_ENTRIES_PER_CELL, PaintRecord,
    SHADER_ABI, SamplerSettings, SpecKey, VtexFile,
};

use crate::pack::PackOptions;

/// The parts of a file that decide what its shader contains.
#[derive(Clone, Copy, Debug)]
pub struct SpecParts<'a> {
    /// Settings of the lookup.
    pub sampler: &'a SamplerSettings,
    /// As [`vtex_format::Grid::texels_per_cell`].
    pub texels_per_cell: u32,
    /// As [`VtexFile::paints`].
    pub paints: &'a [PaintRecord],
    /// As [`VtexFile::cells`].
    pub cells: &'a [u32],
    /// As [`VtexFile::entries`].
    pub entries: &'a [u32],
    /// Whether image 0 is the canvas' mip chain.
    pub canvas_mips: bool,
}

/// The key of `file` as it is stored.
///
/// Image 0 counts as the canvas' mip chain ([`Features::MIPS`]) when it spans the canvas and no
/// entry names it; use [`spec_key_from_parts`] where that is known otherwise.
pub fn spec_key(file: &VtexFile) -> SpecKey {
    spec_key_from_parts(&SpecParts {
        sampler: &file.meta.sampler,
        texels_per_cell: file.meta.grid.texels_per_cell,
        paints: &file.paints,
        cells: &file.cells,
        entries: &file.entries,
        canvas_mips: has_canvas_mips(&file.images, &file.entries),
    })
}

/// The key of `file` once the overrides in `options` are applied.
pub fn spec_key_with(file: &VtexFile, options: &PackOptions) -> SpecKey {
    let sampler = options.applied_to(&file.meta.sampler);
    spec_key_from_parts(&SpecParts {
        sampler: &sampler,
        texels_per_cell: file.meta.grid.texels_per_cell,
        paints: &file.paints,
        cells: &file.cells,
        entries: &file.entries,
        canvas_mips: has_canvas_mips(&file.images, &file.entries),
    })
}

/// The key of a file that is not put together yet. Words that no rule of the format allows are
/// passed over.
pub fn spec_key_from_parts(parts: &SpecParts<'_>) -> SpecKey {
    let address = parts.sampler.address.map(|mode| mode as u32);
    let mut key = SpecKey {
        abi: SHADER_ABI,
        features: 0,
        address_u: address[0],
        address_v: address[1],
        texels_per_cell: parts.texels_per_cell,
        max_entries: 0,
        reserved: [0; 2],
    };
    let is_list = |word: &u32| matches!(CellWord::decode(*word), Some(CellWord::List { .. }));
    if parts.cells.iter().any(is_list) {
        let lists = ListSummary::of(parts);
        key.features |= Features::LISTS | lists.features;
        key.max_entries = lists.longest.min(MAX_ENTRIES_PER_CELL);
    }
    if parts.canvas_mips {
        key.features |= Features::MIPS;
    }
    if parts.sampler.mask {
        key.features |= Features::MASK;
    }
    if parts.sampler.texture_matrix != SamplerSettings::default().texture_matrix {
        key.features |= Features::TEXTURE_MATRIX;
    }
    key
}

struct ListSummary {
    features: u32,
    longest: u32,
}

impl ListSummary {
    fn of(parts: &SpecParts<'_>) -> Self {
        let translucent = |index: u32| {
            let paint = usize::try_from(index)
                .ok()
                .and_then(|i| parts.paints.get(i));
            paint.is_some_and(|paint| !paint.is_opaque())
        };
        let mut summary = Self {
            features: 0,
            longest: 0,
        };
        let mut length = 0;
        for entry in entries(parts.entries) {
            // Lists end at a set bit, so a list is never longer than the run it lies in.
            length += 1;
            summary.longest = summary.longest.max(length);
            if entry.last {
                length = 0;
            }
            summary.features |= match entry.kind {
                EntryKind::Image => Features::IMAGES | Features::TRANSLUCENT,
                EntryKind::Msdf => Features::MSDF,
                EntryKind::Full => 0,
            };
            if entry.kind != EntryKind::Image && translucent(entry.index) {
                summary.features |= Features::TRANSLUCENT;
            }
        }
        // Eq. 2 draws around MSDF shapes only.
        if let (Some(outline), true) = (parts.sampler.outline, summary.has(Features::MSDF)) {
            summary.features |= Features::OUTLINE;
            if translucent(outline.paint) {
                summary.features |= Features::TRANSLUCENT;
            }
        }
        summary
    }

    fn has(&self, feature: u32) -> bool {
        self.features & feature != 0
    }
}

fn entries(words: &[u32]) -> impl Iterator<Item = Entry> {
    let pairs = words.chunks_exact(2);
    pairs.filter_map(|pair| Entry::decode([pair[0], pair[1]]))
}

fn has_canvas_mips(images: &[Image], entry_words: &[u32]) -> bool {
    let spans_canvas = |image: &Image| image.rect_uv == [0.0, 0.0, 1.0, 1.0];
    let names_first = |entry: &Entry| entry.kind == EntryKind::Image && entry.index == 0;
    images.first().is_some_and(spans_canvas) && !entries(entry_words).any(|e| names_first(&e))
}

/// `key` with what no evaluator could be made for put right: unknown bits dropped, features that
/// need another dropped or completed, numbers brought into range.
pub(crate) fn normalized(key: &SpecKey) -> SpecKey {
    const LISTED: u32 = Features::MSDF | Features::IMAGES | Features::TRANSLUCENT;
    let mut features = key.features & Features::ALL;
    if features & Features::LISTS == 0 {
        features &= !LISTED;
    }
    if features & Features::MSDF == 0 {
        features &= !Features::OUTLINE;
    }
    if features & Features::IMAGES != 0 {
        features |= Features::TRANSLUCENT;
    }
    let address = |mode: u32| mode.min(AddressMode::Border as u32);
    SpecKey {
        abi: SHADER_ABI,
        features,
        address_u: address(key.address_u),
        address_v: address(key.address_v),
        texels_per_cell: key.texels_per_cell.clamp(1, MAX_TEXELS_PER_CELL),
        max_entries: key.max_entries.clamp(1, MAX_ENTRIES_PER_CELL),
        reserved: [0; 2],
    }
}

/// Bounds a tile's side so that its texel count stays far inside a `u32`; no reader lets a larger
/// one in.
const MAX_TEXELS_PER_CELL: u32 = 1024;
