//! The key of the specialised shader.

use bytemuck::{Pod, Zeroable};

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
