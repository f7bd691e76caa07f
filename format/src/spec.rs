//! The key of the specialised shader.

use bytemuck::{Pod, Zeroable};

use crate::check::list_lengths;
use crate::{CellWord, Entry, EntryKind, SamplerSettings, VtexFile};

/// Version of the packed words and bindings shared by shaders and loaders. A file whose shader
/// blob carries another ABI is evaluated with the runtime's own text.
pub const SHADER_ABI: u32 = 1;

/// What a specialised shader contains, 32 bytes. Same key, same text.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct SpecKey {
    /// [`SHADER_ABI`].
    pub abi: u32,
    /// Bits of [`Features`].
    pub features: u32,
    /// [`crate::AddressMode`] along u.
    pub address_u: u32,
    /// [`crate::AddressMode`] along v.
    pub address_v: u32,
    /// As [`crate::Grid::texels_per_cell`].
    pub texels_per_cell: u32,
    /// Bound of the entry loop: the longest list in the file.
    pub max_entries: u32,
    /// Zero.
    pub reserved: [u32; 2],
}

/// Bits of [`SpecKey::features`]. Code for an absent feature is not in the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features;

impl Features {
    /// Some cell lists entries; without it every cell is empty or a single colour.
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
    /// Eq. 2's outline is on.
    pub const OUTLINE: u32 = 1 << 6;
    /// The texture matrix is not the identity.
    pub const TEXTURE_MATRIX: u32 = 1 << 7;
    /// All bits this version knows.
    pub const ALL: u32 = (1 << 8) - 1;
}

impl SpecKey {
    /// The smallest key for a file's content and settings; only [`Features::MIPS`], which content
    /// alone does not show, is taken from the file's own key. Bakers end with this.
    pub fn for_file(file: &VtexFile) -> Self {
        let lengths = list_lengths(&file.entries);
        let lists = file
            .cells
            .iter()
            .filter_map(|&word| match CellWord::decode(word) {
                Some(CellWord::List { offset_words }) => lengths.get(offset_words as usize / 2),
                _ => None,
            });
        let [address_u, address_v] = file.meta.sampler.address.map(|mode| mode as u32);
        Self {
            abi: SHADER_ABI,
            features: Self::features_of(file) | (file.spec.features & Features::MIPS),
            address_u,
            address_v,
            texels_per_cell: file.meta.grid.texels_per_cell,
            max_entries: lists.copied().flatten().max().unwrap_or(0),
            reserved: [0; 2],
        }
    }

    /// The features that content and settings need.
    pub(crate) fn features_of(file: &VtexFile) -> u32 {
        let sampler = &file.meta.sampler;
        let mut features = 0;
        let mut need = |needed: bool, feature| features |= if needed { feature } else { 0 };
        need(sampler.mask, Features::MASK);
        let identity = SamplerSettings::default().texture_matrix;
        need(sampler.texture_matrix != identity, Features::TEXTURE_MATRIX);
        let is_list = |&word| matches!(CellWord::decode(word), Some(CellWord::List { .. }));
        if !file.cells.iter().any(is_list) {
            return features;
        }
        need(true, Features::LISTS);
        let is_translucent = |index: u32| {
            let paint = file.paints.get(index as usize);
            paint.is_some_and(|paint| !paint.is_opaque())
        };
        let (pairs, _) = file.entries.as_chunks();
        for entry in pairs.iter().filter_map(|&words| Entry::decode(words)) {
            let is_image = entry.kind == EntryKind::Image;
            need(is_image, Features::IMAGES | Features::TRANSLUCENT);
            need(
                !is_image && is_translucent(entry.index),
                Features::TRANSLUCENT,
            );
            // Eq. 2 draws around MSDF shapes only.
            let outline = sampler.outline.filter(|_| entry.kind == EntryKind::Msdf);
            need(entry.kind == EntryKind::Msdf, Features::MSDF);
            need(outline.is_some(), Features::OUTLINE);
            let translucent = outline.is_some_and(|outline| is_translucent(outline.paint));
            need(translucent, Features::TRANSLUCENT);
        }
        features
    }
}
