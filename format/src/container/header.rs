//! The fixed header: 40 bytes.

use super::layout::{HASH_BYTES, MAGIC, VERSION_MAJOR, VERSION_MINOR, header as at};

/// The fields of a header besides its constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Header {
    pub(crate) major: u16,
    pub(crate) minor: u16,
    pub(crate) section_count: u32,
    pub(crate) file_bytes: u64,
    pub(crate) checksum: [u8; HASH_BYTES],
}

impl Header {
    /// A header of this version, its checksum still zero.
    pub(crate) fn new(section_count: u32, file_bytes: u64) -> Self {
        Self {
            major: VERSION_MAJOR,
            minor: VERSION_MINOR,
            section_count,
            file_bytes,
            checksum: [0; HASH_BYTES],
        }
    }

    /// Reads the fields; the magic bytes are the caller's to check.
    pub(crate) fn decode(bytes: &[u8; at::BYTES]) -> Self {
        Self {
            major: u16::from_le_bytes(field(bytes, at::MAJOR)),
            minor: u16::from_le_bytes(field(bytes, at::MINOR)),
            section_count: u32::from_le_bytes(field(bytes, at::SECTION_COUNT)),
            file_bytes: u64::from_le_bytes(field(bytes, at::FILE_BYTES)),
            checksum: field(bytes, at::CHECKSUM),
        }
    }

    /// The bytes as stored.
    pub(crate) fn encode(&self) -> [u8; at::BYTES] {
        let mut bytes = [0; at::BYTES];
        put(&mut bytes, at::MAGIC, &MAGIC);
        put(&mut bytes, at::MAJOR, &self.major.to_le_bytes());
        put(&mut bytes, at::MINOR, &self.minor.to_le_bytes());
        put(
            &mut bytes,
            at::SECTION_COUNT,
            &self.section_count.to_le_bytes(),
        );
        put(&mut bytes, at::FILE_BYTES, &self.file_bytes.to_le_bytes());
        put(&mut bytes, at::CHECKSUM, &self.checksum);
        bytes
    }

    /// Checksum of this header, its own field taken as zero, and of the section table behind it.
    pub(crate) fn checksum_with(&self, table: &[u8]) -> [u8; HASH_BYTES] {
        // The field cannot cover itself.
        let blank = Self {
            checksum: [0; HASH_BYTES],
            ..*self
        };
        let mut hasher = blake3::Hasher::new();
        hasher.update(&blank.encode()).update(table);
        field(hasher.finalize().as_bytes(), 0)
    }
}

/// `N` bytes from a fixed place of a fixed-size array.
pub(crate) fn field<const N: usize, const BYTES: usize>(
    bytes: &[u8; BYTES],
    offset: usize,
) -> [u8; N] {
    bytes[offset..offset + N]
        .try_into()
        .expect("the slice has N bytes")
}

/// Writes a field at a fixed place.
pub(crate) fn put(bytes: &mut [u8], offset: usize, value: &[u8]) {
    bytes[offset..offset + value.len()].copy_from_slice(value);
}
