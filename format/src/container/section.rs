//! Sections, and the bundles that they are stored in.

use super::header::{field, put};
use super::layout::{
    CODEC_DICTIONARY, CODEC_RAW, CODEC_ZSTD, FLAG_CRITICAL, FLAG_SHARED, HASH_BYTES, bundle, entry,
};
use super::tag::Tag;

/// How a bundle's bytes are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codec {
    /// As they are.
    Raw,
    /// One zstd frame.
    Zstd,
    /// The id of a dictionary that comes with this library, and one zstd frame that refers to it.
    Dictionary,
    /// A later version's way; only bundles that this version skips may have it.
    Unknown(u8),
}

impl Codec {
    fn from_number(number: u8) -> Self {
        match number {
            CODEC_RAW => Self::Raw,
            CODEC_ZSTD => Self::Zstd,
            CODEC_DICTIONARY => Self::Dictionary,
            other => Self::Unknown(other),
        }
    }

    fn number(self) -> u8 {
        match self {
            Self::Raw => CODEC_RAW,
            Self::Zstd => CODEC_ZSTD,
            Self::Dictionary => CODEC_DICTIONARY,
            Self::Unknown(other) => other,
        }
    }
}

/// What a section is called and where it lies in its bundle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SectionInfo {
    /// Its name.
    pub tag: Tag,
    /// Whether a reader that does not know it must refuse the file.
    pub critical: bool,
    /// Index of its bundle in [`crate::Directory::bundles`].
    pub bundle: usize,
    /// First byte in the raw bytes of its bundle.
    pub start_bytes: u64,
    /// Bytes after decompression.
    pub raw_bytes: u64,
    /// Where its entry begins in the file.
    pub entry_offset_bytes: u64,
}

/// One or more sections that are stored, compressed and hashed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BundleInfo {
    /// How it is stored.
    pub codec: Codec,
    /// First byte in the file.
    pub offset_bytes: u64,
    /// Bytes in the file.
    pub stored_bytes: u64,
    /// Bytes after decompression: those of its sections.
    pub raw_bytes: u64,
    /// First 16 bytes of the blake3 of the raw bytes.
    pub hash: [u8; HASH_BYTES],
    /// Index of its first section in [`crate::Directory::sections`].
    pub section_first: usize,
    /// Number of its sections.
    pub section_count: usize,
}

/// An entry's section as it is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SectionEntry {
    pub(crate) tag: Tag,
    pub(crate) flags: u8,
    pub(crate) raw_bytes: u32,
}

/// An entry's bundle as it is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BundleEntry {
    pub(crate) codec: Codec,
    pub(crate) stored_bytes: u32,
    pub(crate) hash: [u8; HASH_BYTES],
}

impl SectionEntry {
    /// The entry of a section of this version.
    pub(crate) fn new(tag: Tag, raw_bytes: u32, shared: bool) -> Self {
        let critical = tag.kind().is_some_and(|kind| kind.critical);
        let flag = |set: bool, flag| if set { flag } else { 0 };
        Self {
            tag,
            flags: flag(critical, FLAG_CRITICAL) | flag(shared, FLAG_SHARED),
            raw_bytes,
        }
    }

    pub(crate) fn decode(bytes: &[u8; entry::BYTES]) -> Self {
        Self {
            tag: Tag(field(bytes, entry::TAG)),
            flags: bytes[entry::FLAGS],
            raw_bytes: u32::from_le_bytes(field(bytes, entry::RAW_BYTES)),
        }
    }

    pub(crate) fn encode(self) -> [u8; entry::BYTES] {
        let mut bytes = [0; entry::BYTES];
        put(&mut bytes, entry::TAG, &self.tag.0);
        bytes[entry::FLAGS] = self.flags;
        put(&mut bytes, entry::RAW_BYTES, &self.raw_bytes.to_le_bytes());
        bytes
    }

    pub(crate) fn is_critical(self) -> bool {
        self.flags & FLAG_CRITICAL != 0
    }

    pub(crate) fn is_shared(self) -> bool {
        self.flags & FLAG_SHARED != 0
    }
}

impl BundleEntry {
    pub(crate) fn decode(bytes: &[u8; bundle::BYTES]) -> Self {
        Self {
            codec: Codec::from_number(bytes[bundle::CODEC]),
            stored_bytes: u32::from_le_bytes(field(bytes, bundle::STORED_BYTES)),
            hash: field(bytes, bundle::HASH),
        }
    }

    pub(crate) fn encode(self) -> [u8; bundle::BYTES] {
        let mut bytes = [0; bundle::BYTES];
        bytes[bundle::CODEC] = self.codec.number();
        put(
            &mut bytes,
            bundle::STORED_BYTES,
            &self.stored_bytes.to_le_bytes(),
        );
        put(&mut bytes, bundle::HASH, &self.hash);
        bytes
    }
}
