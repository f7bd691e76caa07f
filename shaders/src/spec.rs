//! The key of a file's specialised shader, from what the file holds.

pub use vtex_format::SpecParts;
use vtex_format::{
    AddressMode, Entry, EntryKind, Features, Image, MAX_ENTRIES_PER_CELL, MAX_FRAMES, SHADER_ABI,
    SpecKey, VtexFile,
};

use crate::layout::FilterMode;
use crate::pack::PackOptions;

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
    let mut key = spec_key_from_parts(&SpecParts {
        sampler: &sampler,
        texels_per_cell: file.meta.grid.texels_per_cell,
        paints: &file.paints,
        cells: &file.cells,
        entries: &file.entries,
        canvas_mips: has_canvas_mips(&file.images, &file.entries),
    });
    if options.filter != FilterMode::Point {
        key.features |= Features::RAMPS;
    }
    key
}

/// As [`SpecKey::for_parts`].
pub fn spec_key_from_parts(parts: &SpecParts<'_>) -> SpecKey {
    SpecKey::for_parts(parts)
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

/// Whether lists are walked back to front by the evaluator that keeps frames (docs/decisions/0011),
/// whose walk is the order of their items.
pub(crate) const fn is_composited(features: u32) -> bool {
    let ramps = features & (Features::RAMPS | Features::OUTLINE) != 0;
    features & Features::GROUPS != 0 || features & Features::CLIPS != 0 && ramps
}

/// `key` with what no evaluator could be made for put right: unknown bits dropped, features that
/// need another dropped or completed, numbers brought into range.
pub(crate) fn normalized(key: &SpecKey) -> SpecKey {
    const LISTED: u32 =
        Features::MSDF | Features::CURVES | Features::IMAGES | Features::TRANSLUCENT | SCOPED;
    const SCOPED: u32 = Features::CLIPS | Features::GROUPS | Features::BLENDS;
    let mut features = key.features & Features::ALL;
    if features & Features::LISTS == 0 {
        features &= !LISTED;
    }
    if features & Features::BLENDS != 0 {
        features |= Features::GROUPS;
    }
    if features & Features::CLIPS != 0 {
        features |= Features::CURVES;
    }
    if features & (Features::MSDF | Features::CURVES) == 0 {
        features &= !(Features::OUTLINE | Features::RAMPS);
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
        frames: key.frames.clamp(1, MAX_FRAMES),
        reserved: 0,
    }
}

/// Bounds a tile's side so that its texel count stays far inside a `u32`; no reader lets a larger
/// one in.
const MAX_TEXELS_PER_CELL: u32 = 1024;
