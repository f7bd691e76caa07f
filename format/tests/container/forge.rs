//! Takes a file apart and puts it together again with chosen lies, by the offsets of
//! `docs/format.md` section 1 and not by the crate's own.

use vtex_format::Tag;

const HEADER_BYTES: usize = 40;
const SECTION_BYTES: usize = 9;
const BUNDLE_BYTES: usize = 21;

/// A section as the forger wants it, in a bundle of its own unless it is `shared`.
#[derive(Clone)]
pub(crate) struct Forged {
    pub(crate) tag: [u8; 4],
    pub(crate) flags: u8,
    pub(crate) raw_bytes: u32,
    pub(crate) codec: u8,
    /// The bytes in the file, those of a bundle without those of its shared sections.
    pub(crate) stored: Vec<u8>,
    /// Of the raw bytes. Where sections share the bundle the forger makes it.
    pub(crate) hash: [u8; 16],
    /// Stands in the table instead of the stored length.
    pub(crate) stored_lie: Option<u32>,
}

impl Forged {
    /// A critical section stored raw with the right hash.
    pub(crate) fn raw(tag: Tag, bytes: &[u8]) -> Self {
        Self {
            tag: tag.0,
            flags: 1,
            raw_bytes: bytes.len() as u32,
            codec: 0,
            stored: bytes.to_vec(),
            hash: hash(bytes),
            stored_lie: None,
        }
    }

    /// Replaces the content, keeping the name.
    pub(crate) fn refill(&mut self, bytes: &[u8]) {
        let fresh = Self::raw(Tag(self.tag), bytes);
        *self = Self {
            flags: self.flags,
            ..fresh
        };
    }

    /// Puts the section into the bundle of the section before it.
    pub(crate) fn share(&mut self) {
        self.flags |= 2;
    }

    pub(crate) fn is_shared(&self) -> bool {
        self.flags & 2 != 0
    }

    /// The content before packing.
    pub(crate) fn content(&self) -> Vec<u8> {
        unpack(self.codec, &self.stored)
    }
}

pub(crate) fn hash(raw: &[u8]) -> [u8; 16] {
    blake3::hash(raw).as_bytes()[..16].try_into().unwrap()
}

fn unpack(codec: u8, stored: &[u8]) -> Vec<u8> {
    match codec {
        0 => stored.to_vec(),
        _ => zstd::bulk::decompress(stored, 1 << 24).unwrap(),
    }
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// The sections of a sound file, each in a bundle of its own: those that shared one are stored raw.
pub(crate) fn take_apart(bytes: &[u8]) -> Vec<Forged> {
    let mut bundles: Vec<Vec<Forged>> = Vec::new();
    let mut at = HEADER_BYTES;
    for _ in 0..word(bytes, 12) {
        let entry = &bytes[at..];
        at += SECTION_BYTES;
        let mut section = Forged::raw(Tag(entry[..4].try_into().unwrap()), &[]);
        section.flags = entry[4] & !2;
        section.raw_bytes = word(entry, 5);
        if entry[4] & 2 != 0 {
            bundles.last_mut().unwrap().push(section);
            continue;
        }
        let head = &bytes[at..];
        at += BUNDLE_BYTES;
        section.codec = head[0];
        section.hash = head[5..21].try_into().unwrap();
        section.stored = vec![0; word(head, 1) as usize];
        bundles.push(vec![section]);
    }
    for bundle in &mut bundles {
        let stored = &bytes[at..at + bundle[0].stored.len()];
        at += stored.len();
        if bundle.len() == 1 {
            bundle[0].stored = stored.to_vec();
            continue;
        }
        let content = unpack(bundle[0].codec, stored);
        let mut rest = content.as_slice();
        for section in bundle {
            let (own, behind) = rest.split_at(section.raw_bytes as usize);
            section.refill(own);
            rest = behind;
        }
    }
    bundles.concat()
}

/// A file with these sections and a right checksum.
pub(crate) fn put_together(sections: &[Forged]) -> Vec<u8> {
    let mut table = Vec::new();
    let mut payload = Vec::new();
    for (index, section) in sections.iter().enumerate() {
        let rest = &sections[index + 1..];
        let sharing = rest.iter().take_while(|section| section.is_shared());
        let with: Vec<&Forged> = [section].into_iter().chain(sharing).collect();
        let stored: Vec<u8> = with.iter().flat_map(|s| s.stored.clone()).collect();
        table.extend(section.tag);
        table.push(section.flags);
        table.extend(section.raw_bytes.to_le_bytes());
        if section.is_shared() {
            continue;
        }
        let length = section.stored_lie.unwrap_or(stored.len() as u32);
        table.push(section.codec);
        table.extend(length.to_le_bytes());
        table.extend(if with.len() == 1 {
            section.hash
        } else {
            hash(&stored)
        });
        payload.extend(stored);
    }
    let mut bytes = b"\x89VTX\r\n\x1a\n\x02\0\0\0".to_vec();
    bytes.extend((sections.len() as u32).to_le_bytes());
    bytes.resize(HEADER_BYTES, 0);
    bytes.extend(table);
    bytes.extend(payload);
    seal(&mut bytes);
    bytes
}

/// Bytes of the section table of a file.
pub(crate) fn table_bytes(bytes: &[u8]) -> usize {
    let mut at = HEADER_BYTES;
    for _ in 0..word(bytes, 12) {
        let shared = bytes[at + 4] & 2 != 0;
        at += SECTION_BYTES + if shared { 0 } else { BUNDLE_BYTES };
    }
    at - HEADER_BYTES
}

/// Puts the right length and checksum into a header.
pub(crate) fn seal(bytes: &mut [u8]) {
    let length = bytes.len() as u64;
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    bytes[24..40].fill(0);
    let checksum = hash(&bytes[..HEADER_BYTES + table_bytes(bytes)]);
    bytes[24..40].copy_from_slice(&checksum);
}
