//! One entry of the section table: 96 bytes.

use super::header::{field, put};
use super::layout::{CODEC_RAW, CODEC_ZSTD, FLAG_CRITICAL, entry as at};
use super::tag::Tag;

/// How a section's bytes are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// As they are.
    Raw,
    /// One zstd frame.
    Zstd,
    /// A later version's way; only sections that this version skips may have it.
    Unknown(u16),
}

impl Codec {
    fn from_number(number: u16) -> Self {
        match number {
            CODEC_RAW => Self::Raw,
            CODEC_ZSTD => Self::Zstd,
            other => Self::Unknown(other),
        }
    }

    fn number(self) -> u16 {
        match self {
            Self::Raw => CODEC_RAW,
            Self::Zstd => CODEC_ZSTD,
            Self::Unknown(other) => other,
        }
    }
}

/// Where a section lies and what it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectionInfo {
    /// Its name.
    pub tag: Tag,
    /// Whether a reader that does not know it must refuse the file.
    pub critical: bool,
    /// How it is stored.
    pub codec: Codec,
    /// First byte in the file.
    pub offset_bytes: u64,
    /// Bytes in the file.
    pub stored_bytes: u64,
    /// Bytes after decompression.
    pub raw_bytes: u64,
    /// blake3 of the raw bytes.
    pub hash: [u8; 32],
    /// Image index of a `MIPS` section.
    pub image: u32,
    /// Level of a `MIPS` section, 0 finest.
    pub mip: u32,
    /// First layer of a `TILE` section.
    pub layer_first: u32,
    /// Number of layers of a `TILE` section.
    pub layer_count: u32,
}

impl SectionInfo {
    /// Reads the fields; reserved bytes and flags are the caller's to check.
    pub(crate) fn decode(bytes: &[u8; at::BYTES]) -> Self {
        let word = |offset| u32::from_le_bytes(field(bytes, offset));
        let long = |offset| u64::from_le_bytes(field(bytes, offset));
        Self {
            tag: Tag(field(bytes, at::TAG)),
            critical: flags(bytes) & FLAG_CRITICAL != 0,
            codec: Codec::from_number(u16::from_le_bytes(field(bytes, at::CODEC))),
            offset_bytes: long(at::OFFSET),
            stored_bytes: long(at::STORED_BYTES),
            raw_bytes: long(at::RAW_BYTES),
            hash: field(bytes, at::HASH),
            image: word(at::IMAGE),
            mip: word(at::MIP),
            layer_first: word(at::LAYER_FIRST),
            layer_count: word(at::LAYER_COUNT),
        }
    }

    /// The bytes as stored.
    pub(crate) fn encode(&self) -> [u8; at::BYTES] {
        let mut bytes = [0; at::BYTES];
        let flags = if self.critical { FLAG_CRITICAL } else { 0 };
        put(&mut bytes, at::TAG, &self.tag.0);
        put(&mut bytes, at::CODEC, &self.codec.number().to_le_bytes());
        put(&mut bytes, at::FLAGS, &flags.to_le_bytes());
        put(&mut bytes, at::OFFSET, &self.offset_bytes.to_le_bytes());
        put(
            &mut bytes,
            at::STORED_BYTES,
            &self.stored_bytes.to_le_bytes(),
        );
        put(&mut bytes, at::RAW_BYTES, &self.raw_bytes.to_le_bytes());
        put(&mut bytes, at::HASH, &self.hash);
        put(&mut bytes, at::IMAGE, &self.image.to_le_bytes());
        put(&mut bytes, at::MIP, &self.mip.to_le_bytes());
        put(&mut bytes, at::LAYER_FIRST, &self.layer_first.to_le_bytes());
        put(&mut bytes, at::LAYER_COUNT, &self.layer_count.to_le_bytes());
        bytes
    }
}

/// The flags word of an entry.
pub(crate) fn flags(bytes: &[u8; at::BYTES]) -> u16 {
    u16::from_le_bytes(field(bytes, at::FLAGS))
}
