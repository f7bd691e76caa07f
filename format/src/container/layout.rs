//! Where every fixed byte of the header, the section table and the heads of sections lies.
//! `docs/format.md` section 1 is the same in words.

/// First bytes of a file. As in PNG: a byte above 127 shows a 7-bit channel, CR LF and LF show
/// line-end translation, 0x1A stops a careless `type`.
pub(crate) const MAGIC: [u8; 8] = [0x89, b'V', b'T', b'X', 0x0D, 0x0A, 0x1A, 0x0A];
/// Files of another major version are refused.
pub const VERSION_MAJOR: u16 = 2;
/// Higher minor versions add optional sections only and are read.
pub const VERSION_MINOR: u16 = 0;

/// Bounds the section table (1.9 MiB), and so the images a file can hold. Past it a file is
/// malformed.
pub const MAX_SECTIONS: u32 = 65_536;
/// Most raw bytes of a bundle of several sections. It is unpacked before the lengths of its sections
/// are compared with what earlier sections imply, so this is what a lie about them can cost.
pub(crate) const MAX_SHARED_BYTES: u64 = 1 << 16;

/// Byte offsets within the header.
pub(crate) mod header {
    pub(crate) const MAGIC: usize = 0;
    pub(crate) const MAJOR: usize = 8;
    pub(crate) const MINOR: usize = 10;
    pub(crate) const SECTION_COUNT: usize = 12;
    pub(crate) const FILE_BYTES: usize = 16;
    pub(crate) const CHECKSUM: usize = 24;
    pub(crate) const BYTES: usize = 40;
}

/// Leading bytes of a blake3 that a file keeps, of its table as of a bundle. They are there against
/// damage: who forges a file makes its hashes too.
pub(crate) const HASH_BYTES: usize = 16;

/// Byte offsets within an entry of the section table: its section.
pub(crate) mod entry {
    pub(crate) const TAG: usize = 0;
    pub(crate) const FLAGS: usize = 4;
    pub(crate) const RAW_BYTES: usize = 5;
    pub(crate) const BYTES: usize = 9;
}

/// Byte offsets within the rest of an entry whose section begins a bundle.
pub(crate) mod bundle {
    pub(crate) const CODEC: usize = 0;
    pub(crate) const STORED_BYTES: usize = 1;
    pub(crate) const HASH: usize = 5;
    pub(crate) const BYTES: usize = 21;
}

/// [`crate::SectionInfo::critical`] in an entry's flags.
pub(crate) const FLAG_CRITICAL: u8 = 1;
/// The section shares the bundle of the section before it.
pub(crate) const FLAG_SHARED: u8 = 2;
/// Stored bytes are the raw bytes.
pub(crate) const CODEC_RAW: u8 = 0;
/// Stored bytes are one zstd frame that names its content size.
pub(crate) const CODEC_ZSTD: u8 = 1;
/// Stored bytes are the id of a dictionary and a zstd frame as before.
pub(crate) const CODEC_DICTIONARY: u8 = 2;

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
        header::BYTES == header::CHECKSUM + HASH_BYTES,
        "the checksum ends the header"
    );
    assert!(
        bundle::BYTES == bundle::HASH + HASH_BYTES,
        "the hash ends an entry"
    );
};

/// Channels of an MSDF texel that are stored; alpha is always 255.
pub(crate) const TILE_PLANES: usize = 3;

/// Texels of one MSDF tile.
pub(crate) fn tile_texels(texels_per_cell: u32) -> u64 {
    let side = u64::from(texels_per_cell) + 1;
    side * side
}
