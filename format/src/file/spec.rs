//! The key of the specialised shader.

use super::texture::VtexFile;
use crate::cells::blocks::list_frames;
use crate::cells::cell::{CellWord, Entry, EntryKind};
use crate::cells::control::BlendMode;
use crate::cells::lists::{list_entries, list_lengths};
use crate::records::meta::{AddressMode, SamplerSettings};
use crate::records::paint::PaintRecord;

/// Version of the packed words and bindings shared by shaders and loaders. A file whose shader
/// blob carries another ABI is evaluated with the runtime's own text.
pub const SHADER_ABI: u32 = 1;

/// What a specialised shader contains. Same key, same text.
///
/// [`SpecKey::for_file`] makes the key that a file stores; a loader's own, which knows of overrides,
/// is `vtex_shaders::spec_key`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecKey {
    /// [`SHADER_ABI`].
    pub abi: u32,
    /// Bits of [`Features`].
    pub features: u32,
    /// Address mode along u.
    pub address_u: AddressMode,
    /// Address mode along v.
    pub address_v: AddressMode,
    /// As [`crate::Grid::texels_per_cell`].
    pub texels_per_cell: u32,
    /// Bound of the entry loop: the longest list in the file.
    pub max_entries: u32,
    /// Frames of the deepest list in the file, as [`list_frames`](crate::list_frames) counts them.
    pub frames: u32,
    /// Zero.
    pub reserved: u32,
}

impl Default for SpecKey {
    /// No features, clamped, all numbers zero.
    fn default() -> Self {
        Self {
            abi: SHADER_ABI,
            features: 0,
            address_u: AddressMode::Clamp,
            address_v: AddressMode::Clamp,
            texels_per_cell: 0,
            max_entries: 0,
            frames: 0,
            reserved: 0,
        }
    }
}

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
    /// The distance outline of eq. 2 is on.
    pub const OUTLINE: u32 = 1 << 6;
    /// The texture matrix is not the identity.
    pub const TEXTURE_MATRIX: u32 = 1 << 7;
    /// Some entry is a curve record.
    pub const CURVES: u32 = 1 << 8;
    /// Lookups may filter over footprints; without it they are points (a loader's choice, of which
    /// a file says nothing).
    pub const RAMPS: u32 = 1 << 9;
    /// Some cell or entry names a gradient.
    pub const GRADIENTS: u32 = 1 << 10;
    /// Some entry is a test: what shows is clipped.
    pub const CLIPS: u32 = 1 << 11;
    /// Some entries are groups.
    pub const GROUPS: u32 = 1 << 12;
    /// Some group blends other than normally.
    pub const BLENDS: u32 = 1 << 13;
    /// All bits this version knows.
    pub const ALL: u32 = (1 << 14) - 1;
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

    /// Offsets of the lists that cells name, in words.
    fn lists(&self) -> impl Iterator<Item = u32> {
        let words = self.cells.iter();
        words.filter_map(|&word| match CellWord::decode(word) {
            Some(CellWord::List { offset_words }) => Some(offset_words),
            _ => None,
        })
    }

    /// The features that content and settings need.
    fn features(&self) -> u32 {
        let flag = |needed: bool, feature| if needed { feature } else { 0 };
        let features = flag(self.sampler.mask, Features::MASK)
            | flag(self.sampler.is_transformed(), Features::TEXTURE_MATRIX)
            | self.solid_features();
        // Entries that no cell lists need no code.
        if self.lists().next().is_none() {
            return features;
        }
        let (pairs, _) = self.entries.as_chunks();
        let entries = pairs.iter().filter_map(|&words| Entry::decode(words));
        entries.fold(features | Features::LISTS, |features, entry| {
            features | self.entry_features(entry)
        })
    }

    fn entry_features(&self, entry: Entry) -> u32 {
        let kind = match entry.kind {
            EntryKind::Image => return Features::IMAGES | Features::TRANSLUCENT,
            EntryKind::Full => 0,
            EntryKind::Msdf => Features::MSDF,
            EntryKind::Curves => Features::CURVES,
            EntryKind::Test => return Features::CLIPS | Features::CURVES,
            EntryKind::Close if entry.index != BlendMode::Normal as u32 => {
                return Features::GROUPS | Features::BLENDS;
            }
            EntryKind::Open | EntryKind::Close | EntryKind::Mask => return Features::GROUPS,
        };
        // Eq. 2 draws around outlines only, not around cells.
        let outline = self.sampler.outline.filter(|_| kind != 0);
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

    /// Length of the longest list that a cell names; lists that do not end are passed over.
    fn longest_list(&self) -> u32 {
        let lengths = list_lengths(self.entries);
        let lists = self
            .lists()
            .filter_map(|offset_words| lengths.get(offset_words as usize / 2));
        lists.copied().flatten().max().unwrap_or(0)
    }

    /// Frames of the deepest list that a cell names; lists that break a rule are passed over.
    fn deepest_list(&self) -> u32 {
        // Only control entries take frames.
        if self.features() & (Features::CLIPS | Features::GROUPS) == 0 {
            return 0;
        }
        // Cells share lists; each is parsed once.
        let mut seen = vec![false; self.entries.len() / 2];
        let lists = self.lists().filter_map(|offset_words| {
            let place = offset_words as usize / 2;
            let seen = seen.get_mut(place)?;
            let first = !std::mem::replace(seen, true);
            first.then(|| list_entries(self.entries, place))?
        });
        lists
            .filter_map(|list| list_frames(&list).ok())
            .max()
            .unwrap_or(0)
    }
}

impl SpecKey {
    /// Words of `SPEC`.
    pub const WORDS: usize = 8;

    /// The smallest key for a file's content and settings; only [`Features::MIPS`], which content
    /// alone does not show, is taken from the file's own key. Bakers end with this. Words that no
    /// rule of the format allows are passed over.
    pub fn for_file(file: &VtexFile) -> Self {
        let content = Content::of(file);
        let [address_u, address_v] = file.meta.sampler.address;
        Self {
            features: content.features() | (file.spec.features & Features::MIPS),
            address_u,
            address_v,
            texels_per_cell: file.meta.grid.texels_per_cell,
            max_entries: content.longest_list(),
            frames: content.deepest_list(),
            ..Self::default()
        }
    }

    /// The features that content and settings of a file need, besides [`Features::MIPS`].
    pub(crate) fn features_of(file: &VtexFile) -> u32 {
        Content::of(file).features()
    }

    /// The words of `SPEC`.
    pub fn encode(&self) -> [u32; Self::WORDS] {
        [
            self.abi,
            self.features,
            self.address_u as u32,
            self.address_v as u32,
            self.texels_per_cell,
            self.max_entries,
            self.frames,
            self.reserved,
        ]
    }

    /// Reads the words of `SPEC`; `None` for an address mode that does not exist.
    pub(crate) fn decode(words: [u32; Self::WORDS]) -> Option<Self> {
        let [
            abi,
            features,
            address_u,
            address_v,
            texels_per_cell,
            max_entries,
            frames,
            reserved,
        ] = words;
        Some(Self {
            abi,
            features,
            address_u: AddressMode::from_number(address_u)?,
            address_v: AddressMode::from_number(address_v)?,
            texels_per_cell,
            max_entries,
            frames,
            reserved,
        })
    }
}
