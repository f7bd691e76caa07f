//! The packed words that evaluators read: one `array<u32>` holds a whole texture.
//!
//! Several textures can lie in one array; every offset is relative to the texture's first word,
//! so that a packed texture can be moved. All floats are f32 bits.

/// Words of the header, by index. `wgsl/core/layout.wgsl` holds the same constants; a test
/// compares them through naga.
pub mod header {
    /// [`vtex_format::SHADER_ABI`].
    pub const ABI: u32 = 0;
    /// [`crate::FilterMode`](super::FilterMode).
    pub const FILTER: u32 = 1;
    /// [`vtex_format::AddressMode`] along u.
    pub const ADDRESS_U: u32 = 2;
    /// [`vtex_format::AddressMode`] along v.
    pub const ADDRESS_V: u32 = 3;
    /// Six floats a b c d e f: `u' = a u + c v + e`, `v' = b u + d v + f`.
    pub const TEXTURE_MATRIX: u32 = 4;
    /// Two floats: cells a unit of uv.
    pub const CELL_FROM_UV_SCALE: u32 = 10;
    /// Two floats: lattice origin.
    pub const CELL_FROM_UV_OFFSET: u32 = 12;
    /// Two integers: columns and rows.
    pub const GRID_SIZE: u32 = 14;
    /// Lattice steps of an MSDF tile along a cell.
    pub const TEXELS_PER_CELL: u32 = 16;
    /// Float: full distance range in texels.
    pub const DISTANCE_RANGE: u32 = 17;
    /// Float: half width S of [SFG22] eq. 1.
    pub const SMOOTHING: u32 = 18;
    /// Float: eq. 2's width in texels; 0 when off.
    pub const OUTLINE_WIDTH: u32 = 19;
    /// Paint index of eq. 2's outline.
    pub const OUTLINE_PAINT: u32 = 20;
    /// First word of the cells.
    pub const CELLS: u32 = 21;
    /// First word of the entries.
    pub const ENTRIES: u32 = 22;
    /// First word of the paints, [`super::PAINT_WORDS`] each.
    pub const PAINTS: u32 = 23;
    /// First word of the tiles, `(texels_per_cell + 1)^2` each, one RGBA8 texel a word.
    pub const TILES: u32 = 24;
    /// First word of the image records, [`super::IMAGE_WORDS`] each.
    pub const IMAGES: u32 = 25;
    /// Number of images.
    pub const IMAGE_COUNT: u32 = 26;
    /// Bits of [`vtex_format::Features`].
    pub const FEATURES: u32 = 27;
    /// Words of the header; the rest are zero.
    pub const WORDS: u32 = 32;
}

/// Words of a paint: linear-light premultiplied RGBA, then sRGB-encoded straight RGBA, as floats.
pub const PAINT_WORDS: u32 = 8;

/// Words of a paint, by index.
pub mod paint {
    /// Four floats: linear light, premultiplied.
    pub const LINEAR: u32 = 0;
    /// Four floats: sRGB-encoded, straight alpha.
    pub const ENCODED: u32 = 4;
}

/// Words of an image record: `rect_uv` (4 floats), width, height, level count, 0, then the first
/// word of each of 16 levels. A texel is two words, four halves: linear light, premultiplied.
pub const IMAGE_WORDS: u32 = 24;

/// Words of an image record, by index, and of its texels.
pub mod image {
    /// Four floats: left, top, right, bottom in uv.
    pub const RECT_UV: u32 = 0;
    /// Two integers: texels of level 0.
    pub const SIZE: u32 = 4;
    /// Number of levels, at most [`vtex_format::MAX_MIPS`].
    pub const LEVEL_COUNT: u32 = 6;
    /// First word of each level.
    pub const LEVELS: u32 = 8;
    /// Words of a texel.
    pub const TEXEL_WORDS: u32 = 2;
}

/// Parts of a cell's word: [`vtex_format::CellWord`].
pub mod cell {
    /// Bits below the tag.
    pub const PAYLOAD_MASK: u32 = (1 << TAG_SHIFT) - 1;
    /// Position of the tag.
    pub const TAG_SHIFT: u32 = vtex_format::CELL_TAG_SHIFT;
    /// Tag of an empty cell.
    pub const EMPTY: u32 = 0;
    /// Tag of a cell of one colour.
    pub const SOLID: u32 = 1;
    /// Tag of a cell with a list.
    pub const LIST: u32 = 2;
}

/// Parts of an entry's first word: [`vtex_format::Entry`].
pub mod entry {
    use vtex_format::EntryKind;

    /// Words of an entry.
    pub const WORDS: u32 = 2;
    /// Position of the kind.
    pub const KIND_SHIFT: u32 = 28;
    /// Set in the last, backmost entry.
    pub const LAST_BIT: u32 = 1 << 27;
    /// Set where nothing behind a coverage of 1 shows.
    pub const OPAQUE_BIT: u32 = 1 << 26;
    /// Bits of the paint or image index.
    pub const INDEX_MASK: u32 = OPAQUE_BIT - 1;
    /// [`EntryKind::Full`].
    pub const FULL: u32 = EntryKind::Full as u32;
    /// [`EntryKind::Msdf`].
    pub const MSDF: u32 = EntryKind::Msdf as u32;
    /// [`EntryKind::Image`].
    pub const IMAGE: u32 = EntryKind::Image as u32;
}

/// How a lookup turns distances into coverage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum FilterMode {
    /// Hard inside test; the caller's samples antialias.
    #[default]
    Point = 0,
    /// A ramp as wide as the footprint.
    Footprint = 1,
    /// [SFG22] eq. 1: a smoothstep of constant half width S.
    Paper = 2,
}

/// One query of the batch kernel, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BatchQuery {
    /// Point in uv before texture matrix and address mode.
    pub uv: [f32; 2],
    /// Zero.
    pub padding: [f32; 2],
    /// Two axes of the filter region, `axis0.u, axis0.v, axis1.u, axis1.v`, full extents in uv.
    pub footprint: [f32; 4],
}
