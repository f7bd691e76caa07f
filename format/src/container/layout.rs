//! Where every fixed byte of the header, the section table and the heads of sections lies.
//! `docs/format.md` section 1 is the same in words.

/// First bytes of a file. As in PNG: a byte above 127 shows a 7-bit channel, CR LF and LF show
/// line-end translation, 0x1A stops a careless `type`.
pub(crate) const MAGIC: [u8; 8] = [0x89, b'V', b'T', b'X', 0x0D, 0x0A, 0x1A, 0x0A];
/// Files of another major version are refused.
pub const VERSION_MAJOR: u16 = 1;
/// Higher minor versions add optional sections only and are read.
pub const VERSION_MINOR: u16 = 0;

/// Sections and their payloads start at multiples of this, a cache line.
pub(crate) const ALIGNMENT_BYTES: u64 = 64;
/// Bounds the section table (6 MiB), and so the images a file can hold. Past it a file is
/// malformed.
pub const MAX_SECTIONS: u32 = 65_536;

/// Byte offsets within the header.
pub(crate) mod header {
    pub(crate) const MAGIC: usize = 0;
    pub(crate) const MAJOR: usize = 8;
    pub(crate) const MINOR: usize = 10;
    pub(crate) const SECTION_COUNT: usize = 12;
    pub(crate) const FILE_BYTES: usize = 16;
    pub(crate) const CHECKSUM: usize = 24;
    /// Leading bytes of the blake3 that are kept: enough against damage.
    pub(crate) const CHECKSUM_BYTES: usize = 16;
    pub(crate) const RESERVED: usize = 40;
    pub(crate) const BYTES: usize = 64;
}

/// Byte offsets within an entry of the section table.
pub(crate) mod entry {
    pub(crate) const TAG: usize = 0;
    pub(crate) const CODEC: usize = 4;
    pub(crate) const FLAGS: usize = 6;
    pub(crate) const OFFSET: usize = 8;
    pub(crate) const STORED_BYTES: usize = 16;
    pub(crate) const RAW_BYTES: usize = 24;
    pub(crate) const HASH: usize = 32;
    pub(crate) const IMAGE: usize = 64;
    pub(crate) const MIP: usize = 68;
    pub(crate) const LAYER_FIRST: usize = 72;
    pub(crate) const LAYER_COUNT: usize = 76;
    pub(crate) const RESERVED: usize = 80;
    pub(crate) const BYTES: usize = 96;
}

/// [`crate::SectionInfo::critical`] in an entry's flags.
pub(crate) const FLAG_CRITICAL: u16 = 1;
/// Stored bytes are the raw bytes.
pub(crate) const CODEC_RAW: u16 = 0;
/// Stored bytes are one zstd frame that names its content size.
pub(crate) const CODEC_ZSTD: u16 = 1;

/// Bytes of `SHDR` before its text.
pub(crate) const SHADER_HEAD_BYTES: usize = 16;

/// Byte offsets of META's fields. Everything before the outline has a fixed place.
pub(crate) mod meta {
    pub(crate) const CANVAS_SIZE: u64 = 0;
    pub(crate) const GRID_SIZE: u64 = 8;
    pub(crate) const GRID_SCALE: u64 = 16;
    pub(crate) const GRID_OFFSET: u64 = 24;
    pub(crate) const TEXELS_PER_CELL: u64 = 32;
    pub(crate) const DISTANCE_RANGE: u64 = 36;
    pub(crate) const MAX_ZOOM: u64 = 40;
    pub(crate) const TEXTURE_MATRIX: u64 = 44;
    pub(crate) const SMOOTHING: u64 = 76;
    pub(crate) const OUTLINE_WIDTH: u64 = 82;
    pub(crate) const OUTLINE_PAINT: u64 = 86;
    /// Without a distance outline; one moves the lattice back by [`OUTLINE_BYTES`].
    pub(crate) const CURVE_LATTICE: u64 = 83;
    pub(crate) const OUTLINE_BYTES: u64 = 8;
}

const _: () = {
    assert!(
        header::RESERVED == header::CHECKSUM + header::CHECKSUM_BYTES,
        "header fields abut"
    );
    assert!(
        header::BYTES as u64 == ALIGNMENT_BYTES,
        "the table follows the header directly"
    );
    assert!(entry::IMAGE == entry::HASH + 32, "entry fields abut");
};

/// `offset` rounded up to the next section boundary; `None` past the end of u64.
pub(crate) fn align_up(offset: u64) -> Option<u64> {
    offset.checked_next_multiple_of(ALIGNMENT_BYTES)
}

/// Channels of an MSDF texel that are stored; alpha is always 255.
pub(crate) const TILE_PLANES: usize = 3;

/// Texels of one MSDF tile.
pub(crate) fn tile_texels(texels_per_cell: u32) -> u64 {
    let side = u64::from(texels_per_cell) + 1;
    side * side
}
