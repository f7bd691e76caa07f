//! The key of the specialised shader.

use super::texture::VtexFile;
use crate::cells::cell::{CellWord, Entry, EntryKind};
use crate::cells::control::BlendMode;
use crate::records::meta::SamplerSettings;
use crate::records::paint::PaintRecord;

/// Version of the packed words and bindings shared by shaders and loaders. A file whose shader
/// blob carries another ABI is evaluated with the runtime's own text.
pub const SHADER_ABI: u32 = 5;
/// Keys of files are read from this ABI on: they are the same features.
pub(crate) const OLDEST_ABI: u32 = 2;

/// What a specialised shader contains: a set of features. Same key, same text.
///
/// [`SpecKey::for_file`] makes the key that a file stores; a loader's own, which knows of overrides,
/// is `vtex_shaders::spec_key`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SpecKey {
    /// Bits of [`Features`].
    pub features: u32,
}

/// Groups and masks of a list that may be open at once without [`Features::DEEP_GROUPS`].
///
/// An evaluator keeps a level of its blend stack, five words, for each. Two still lie in registers
/// at little cost, and no list of 330 real files needs more (docs/decisions/0017).
pub const SHALLOW_BLEND_DEPTH: u32 = 2;

/// Bits of [`SpecKey::features`]. Code for an absent feature is not in the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features;

impl Features {
    /// Some cell lists entries; without it every cell is empty or has a single paint.
    pub const LISTS: u32 = 1 << 0;
    /// Some entry is an MSDF tile.
    pub const MSDF: u32 = 1 << 1;
    /// Some entry is a raster image.
    pub const IMAGES: u32 = 1 << 2;
    /// Image 0 is the canvas' mip chain.
    pub const MIPS: u32 = 1 << 3;
    /// Some listed paint is translucent, or an image is listed.
    pub const TRANSLUCENT: u32 = 1 << 4;
    /// Lookups return alpha in all four channels.
    pub const MASK: u32 = 1 << 5;
    /// The distance outline of eq. 2 is on, and some entry is an MSDF tile.
    pub const OUTLINE: u32 = 1 << 6;
    /// The texture matrix is not the identity, or an address mode is not clamp.
    pub const MAPPING: u32 = 1 << 7;
    /// Some entry is a curve record.
    pub const CURVES: u32 = 1 << 8;
    /// Lookups average over footprints (a loader's choice, of which a file says nothing).
    pub const FOOTPRINT: u32 = 1 << 9;
    /// Some cell or entry names a gradient.
    pub const GRADIENTS: u32 = 1 << 10;
    /// Some entry is a branch: what shows is clipped.
    pub const CLIPS: u32 = 1 << 11;
    /// Some entries are groups.
    pub const GROUPS: u32 = 1 << 12;
    /// Some group blends other than normally.
    pub const BLENDS: u32 = 1 << 13;
    /// Edges of MSDFs are \[SFG22\]'s ramps (a loader's choice too).
    pub const PAPER: u32 = 1 << 14;
    /// In some list more than [`SHALLOW_BLEND_DEPTH`] groups and masks are open at once.
    pub const DEEP_GROUPS: u32 = 1 << 15;
    /// All bits this version knows.
    pub const ALL: u32 = (1 << 16) - 1;
}

/// The parts of a file that decide what its shader contains.
struct Content<'a> {
    sampler: &'a SamplerSettings,
    paints: &'a [PaintRecord],
    cells: &'a [u32],
    entries: &'a [u32],
}

impl<'a> Content<'a> {
    fn of(file: &'a VtexFile) -> Self {
        Self {
            sampler: &file.meta.sampler,
            paints: &file.paints,
            cells: &file.cells,
            entries: &file.entries,
        }
    }

    fn is_translucent(&self, paint: u32) -> bool {
        let paint = self.paints.get(paint as usize);
        paint.is_some_and(|paint| !paint.is_opaque())
    }

    fn gradient_feature(&self, paint: u32) -> u32 {
        let paint = self.paints.get(paint as usize);
        let gradient = paint.is_some_and(PaintRecord::is_gradient);
        if gradient { Features::GRADIENTS } else { 0 }
    }

    /// What cells of a single paint need.
    fn solid_features(&self) -> u32 {
        let words = self.cells.iter();
        let paints = words.filter_map(|&word| match CellWord::decode(word) {
            Some(CellWord::Paint { paint }) => Some(paint),
            _ => None,
        });
        paints.fold(0, |features, paint| features | self.gradient_feature(paint))
    }

    fn has_lists(&self) -> bool {
        let mut words = self.cells.iter();
        words.any(|&word| matches!(CellWord::decode(word), Some(CellWord::List { .. })))
    }

    /// The features that content and settings need.
    fn features(&self) -> u32 {
        let flag = |needed: bool, feature| if needed { feature } else { 0 };
        let features = flag(self.sampler.mask, Features::MASK)
            | flag(self.sampler.is_mapped(), Features::MAPPING)
            | self.solid_features();
        // Entries that no cell lists need no code.
        if !self.has_lists() {
            return features;
        }
        let (pairs, _) = self.entries.as_chunks();
        let entries = || pairs.iter().filter_map(|&words| Entry::decode(words));
        let deep = flag(is_deep(entries()), Features::DEEP_GROUPS);
        entries().fold(features | Features::LISTS | deep, |features, entry| {
            features | self.entry_features(entry)
        })
    }

    fn entry_features(&self, entry: Entry) -> u32 {
        let kind = match entry.kind {
            EntryKind::Image => return Features::IMAGES | Features::TRANSLUCENT,
            EntryKind::Full => 0,
            EntryKind::Msdf => Features::MSDF,
            EntryKind::Curves => Features::CURVES,
            EntryKind::Branch => return Features::CLIPS | Features::CURVES,
            EntryKind::Close if entry.index != BlendMode::Normal as u32 => {
                return Features::GROUPS | Features::BLENDS;
            }
            EntryKind::Open | EntryKind::Close | EntryKind::Mask => return Features::GROUPS,
        };
        // Eq. 2 is of distances, which MSDFs alone store.
        let outline = self.sampler.outline.filter(|_| kind == Features::MSDF);
        let translucent = self.is_translucent(entry.index)
            || outline.is_some_and(|outline| self.is_translucent(outline.paint));
        kind | self.gradient_feature(entry.index)
            | if translucent {
                Features::TRANSLUCENT
            } else {
                0
            }
            | if outline.is_some() {
                Features::OUTLINE
            } else {
                0
            }
    }
}

/// Whether more than [`SHALLOW_BLEND_DEPTH`] groups and masks of a list are open at once. Lists
/// that share a suffix share whole blocks, in which as many open as close, so one pass over all
/// entries will do.
fn is_deep(entries: impl Iterator<Item = Entry>) -> bool {
    let mut depth = 0_u32;
    for entry in entries {
        match entry.kind {
            EntryKind::Open => depth += 1,
            EntryKind::Close | EntryKind::Mask => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > SHALLOW_BLEND_DEPTH {
            return true;
        }
        if entry.last {
            depth = 0;
        }
    }
    false
}

impl SpecKey {
    /// Words of `SPEC`.
    pub(crate) const WORDS: usize = 8;

    /// The smallest key for a file's content and settings; only [`Features::MIPS`], which content
    /// alone does not show, is taken from the file's own key. Bakers end with this. Words that no
    /// rule of the format allows are passed over.
    pub fn for_file(file: &VtexFile) -> Self {
        Self {
            features: Self::features_of(file) | (file.spec.features & Features::MIPS),
        }
    }

    /// The features that content and settings of a file need, besides [`Features::MIPS`].
    pub(crate) fn features_of(file: &VtexFile) -> u32 {
        // No file has none: a reader has left them out, and the key alone says what they need.
        if file.cells.is_empty() {
            return file.spec.features;
        }
        Content::of(file).features()
    }

    /// The words of `SPEC`, of [`SHADER_ABI`].
    pub(crate) fn encode(self) -> [u32; Self::WORDS] {
        [SHADER_ABI, self.features, 0, 0, 0, 0, 0, 0]
    }
}
