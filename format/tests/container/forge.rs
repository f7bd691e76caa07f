//! Takes a file apart and puts it together again with chosen lies, by the offsets of
//! `docs/format.md` section 1 and not by the crate's own.

use vtex_format::Tag;

/// A section as the forger wants it.
#[derive(Clone)]
pub(crate) struct Forged {
    pub(crate) tag: [u8; 4],
    pub(crate) codec: u16,
    pub(crate) flags: u16,
    pub(crate) stored: Vec<u8>,
    pub(crate) raw_bytes: u64,
    pub(crate) hash: [u8; 32],
    pub(crate) parts: [u32; 4],
    pub(crate) reserved: [u8; 16],
    /// Added to the section's rightful place, its stored bytes staying there.
    pub(crate) offset_lie: i64,
    /// Stands in the table instead of the stored length.
    pub(crate) stored_lie: Option<u64>,
}

impl Forged {
    /// A section stored raw with the right hash.
    pub(crate) fn raw(tag: Tag, bytes: &[u8]) -> Self {
        Self {
            tag: tag.0,
            codec: 0,
            flags: 1,
            stored: bytes.to_vec(),
            raw_bytes: bytes.len() as u64,
            hash: *blake3::hash(bytes).as_bytes(),
            parts: [0; 4],
            reserved: [0; 16],
            offset_lie: 0,
            stored_lie: None,
        }
    }

    /// Replaces the content, keeping name and parts.
    pub(crate) fn refill(&mut self, bytes: &[u8]) {
        let fresh = Self::raw(Tag(self.tag), bytes);
        *self = Self {
            flags: self.flags,
            parts: self.parts,
            ..fresh
        };
    }

    /// The content before packing.
    pub(crate) fn content(&self) -> Vec<u8> {
        match self.codec {
            0 => self.stored.clone(),
            _ => zstd::bulk::decompress(&self.stored, 1 << 24).unwrap(),
        }
    }
}

/// The sections of a sound file.
pub(crate) fn take_apart(bytes: &[u8]) -> Vec<Forged> {
    let count = u32::from_le_bytes(bytes[12..16].try_into().unwrap());
    let entries = bytes[64..].chunks_exact(96).take(count as usize);
    let forged = entries.map(|entry| {
        let word = |at: usize| u32::from_le_bytes(entry[at..at + 4].try_into().unwrap());
        let long = |at: usize| u64::from_le_bytes(entry[at..at + 8].try_into().unwrap());
        let (start, length) = (long(8) as usize, long(16) as usize);
        Forged {
            tag: entry[..4].try_into().unwrap(),
            codec: word(4) as u16,
            flags: (word(4) >> 16) as u16,
            stored: bytes[start..start + length].to_vec(),
            raw_bytes: long(24),
            hash: entry[32..64].try_into().unwrap(),
            parts: [word(64), word(68), word(72), word(76)],
            reserved: entry[80..96].try_into().unwrap(),
            offset_lie: 0,
            stored_lie: None,
        }
    });
    forged.collect()
}

/// A file with these sections and a right checksum.
pub(crate) fn put_together(sections: &[Forged]) -> Vec<u8> {
    let mut bytes = vec![0; 64 + 96 * sections.len()];
    let mut table = Vec::new();
    for section in sections {
        bytes.resize(bytes.len().next_multiple_of(64), 0);
        let offset = (bytes.len() as u64).wrapping_add_signed(section.offset_lie);
        let stored = section.stored_lie.unwrap_or(section.stored.len() as u64);
        table.extend(section.tag);
        table.extend(section.codec.to_le_bytes());
        table.extend(section.flags.to_le_bytes());
        table.extend(
            [offset, stored, section.raw_bytes]
                .map(u64::to_le_bytes)
                .as_flattened(),
        );
        table.extend(section.hash);
        table.extend(section.parts.map(u32::to_le_bytes).as_flattened());
        table.extend(section.reserved);
        bytes.extend(&section.stored);
    }
    bytes[64..64 + table.len()].copy_from_slice(&table);
    bytes[..12].copy_from_slice(b"\x89VTX\r\n\x1a\n\x01\0\0\0");
    bytes[12..16].copy_from_slice(&(sections.len() as u32).to_le_bytes());
    seal(&mut bytes);
    bytes
}

/// Puts the right length and checksum into a header.
pub(crate) fn seal(bytes: &mut [u8]) {
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..40].fill(0);
    let count = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    // The checksum takes reserved bytes as zero, whatever stands there.
    let mut hasher = blake3::Hasher::new();
    hasher.update(&bytes[..40]).update(&[0; 24]);
    hasher.update(&bytes[64..64 + 96 * count]);
    let checksum = hasher.finalize();
    bytes[24..40].copy_from_slice(&checksum.as_bytes()[..16]);
}
