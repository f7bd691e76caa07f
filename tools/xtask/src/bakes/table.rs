//! The section table of a `.vtex` file, as docs/format.md lays it out. Read here byte by byte and
//! not with `vtex-format`: what is compared must not change together with the comparison.

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, Result, ensure};

const MAGIC: [u8; 8] = *b"\x89VTX\r\n\x1a\n";
const HEADER_BYTES: usize = 64;
const ENTRY_BYTES: usize = 96;

/// Which section of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    pub(crate) tag: String,
    /// Image and level of `MIPS`.
    image: [u32; 2],
    /// First layer and number of layers of `TILE`.
    layers: [u32; 2],
}

/// What a section holds, without how it is stored: codec, offset and stored length may change with
/// the compressor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Content {
    flags: u16,
    pub(crate) raw_bytes: u64,
    /// blake3 of the raw bytes.
    hash: [u8; 32],
}

/// The sections of a file; the version in its header counts as one called `HEAD`.
pub(crate) type Sections = BTreeMap<Name, Content>;

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([image, level], [first, layers]) = (self.image, self.layers);
        match self.tag.as_str() {
            "MIPS" => write!(f, "MIPS image {image} level {level}"),
            "TILE" => write!(f, "TILE {layers} layers from {first}"),
            tag => f.write_str(tag),
        }
    }
}

/// Reads the header and the table of a whole file.
pub(crate) fn sections(file: &[u8]) -> Result<Sections> {
    let header = file.get(..HEADER_BYTES).context("no header")?;
    ensure!(header.starts_with(&MAGIC), "no .vtex file");
    let count = usize::try_from(u32::from_le_bytes(take(header, 12)))?;
    let table = &file[HEADER_BYTES..];
    let mut sections = Sections::from([version(header)]);
    for entry in table.chunks_exact(ENTRY_BYTES).take(count) {
        let number = |at| u32::from_le_bytes(take(entry, at));
        let name = Name {
            tag: String::from_utf8_lossy(&entry[..4]).into_owned(),
            image: [number(64), number(68)],
            layers: [number(72), number(76)],
        };
        let content = Content {
            flags: u16::from_le_bytes(take(entry, 6)),
            raw_bytes: u64::from_le_bytes(take(entry, 24)),
            hash: take(entry, 32),
        };
        let text = name.to_string();
        let twice = sections.insert(name, content).is_some();
        ensure!(!twice, "{text} is there twice");
    }
    ensure!(sections.len() == count + 1, "the table is cut off");
    Ok(sections)
}

fn version(header: &[u8]) -> (Name, Content) {
    let mut hash = [0; 32];
    hash[..4].copy_from_slice(&header[8..12]);
    let name = Name {
        tag: "HEAD".to_owned(),
        image: [0; 2],
        layers: [0; 2],
    };
    let content = Content {
        flags: 0,
        raw_bytes: 4,
        hash,
    };
    (name, content)
}

/// `N` bytes of a header or an entry, whose length is known.
fn take<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    let mut taken = [0; N];
    taken.copy_from_slice(&bytes[at..at + N]);
    taken
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A file of empty sections: tag, first layer, first byte of the hash.
    pub(crate) fn file(sections: &[(&str, u8, u8)]) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &[1, 0, 0, 0]].concat();
        bytes.extend(u32::try_from(sections.len()).unwrap().to_le_bytes());
        bytes.resize(HEADER_BYTES, 0);
        for &(tag, layer, hash) in sections {
            let mut entry = [0; ENTRY_BYTES];
            entry[..4].copy_from_slice(tag.as_bytes());
            (entry[24], entry[32], entry[72]) = (200, hash, layer);
            bytes.extend(entry);
        }
        bytes
    }

    #[test]
    fn what_is_stored_otherwise_is_the_same() {
        let mut other = file(&[("META", 0, 1), ("TILE", 4, 2)]);
        let before = sections(&other).unwrap();
        let names: Vec<String> = before.keys().map(Name::to_string).collect();
        assert_eq!(names, ["HEAD", "META", "TILE 0 layers from 4"]);
        // Codec, offset and stored length of the first section.
        for at in [4, 8, 16] {
            other[HEADER_BYTES + at] += 1;
        }
        assert_eq!(sections(&other).unwrap(), before);
        for at in [8, HEADER_BYTES + 24, HEADER_BYTES + 63] {
            let mut other = other.clone();
            other[at] += 1;
            assert_ne!(sections(&other).unwrap(), before, "byte {at}");
        }
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let good = file(&[("META", 0, 1), ("META", 1, 1)]);
        assert!(sections(&good).is_ok());
        assert!(sections(&good[..good.len() - 1]).is_err(), "cut off");
        assert!(sections(&good[1..]).is_err(), "no magic");
        assert!(sections(&file(&[("META", 0, 1), ("META", 0, 2)])).is_err());
    }
}
