//! The sections of a `.vtex` file, as docs/format.md lays them out. Read here byte by byte and not
//! with `vtex-format`: what is compared must not change together with the comparison.

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, Result, ensure};

const MAGIC: [u8; 8] = *b"\x89VTX\r\n\x1a\n";
const MAJOR_VERSION: u16 = 2;
const HEADER_BYTES: usize = 40;
const SECTION_BYTES: usize = 9;
const BUNDLE_BYTES: usize = 21;
/// The section shares the bundle of the section before it.
const FLAG_SHARED: u8 = 2;

/// Which section of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    pub(crate) tag: String,
    /// How many sections of this tag come before it.
    number: usize,
}

/// What a section holds, without how it is stored: bundles, codecs and stored lengths may change with
/// the writer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Content {
    critical: bool,
    raw: Vec<u8>,
}

impl Content {
    pub(crate) fn raw_bytes(&self) -> usize {
        self.raw.len()
    }
}

/// The sections of a file; the version in its header counts as one called `HEAD`.
pub(crate) type Sections = BTreeMap<Name, Content>;

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.tag.as_str() {
            "MIPS" | "TILE" => write!(f, "{} {}", self.tag, self.number),
            tag => f.write_str(tag),
        }
    }
}

/// A section as the table has it.
struct Entry {
    tag: String,
    flags: u8,
    raw_bytes: usize,
    /// Codec and stored length of the bundle that it begins.
    bundle: Option<(u8, usize)>,
}

/// Reads a whole file.
pub(crate) fn sections(file: &[u8]) -> Result<Sections> {
    let mut rest = file;
    let header = rest.split_off(..HEADER_BYTES).context("no header")?;
    ensure!(header.starts_with(&MAGIC), "no .vtex file");
    let version = u16::from_le_bytes([header[8], header[9]]);
    ensure!(version == MAJOR_VERSION, "a file of version {version}");
    let count = number(&mut &header[12..])?;
    let table = (0..count).map(|_| entry(&mut rest));
    let table = table.collect::<Result<Vec<_>>>()?;
    let mut sections = Sections::new();
    add(&mut sections, "HEAD", false, &header[8..12]);
    let mut content = Vec::new();
    for (index, entry) in table.iter().enumerate() {
        if let Some((codec, stored_bytes)) = entry.bundle {
            ensure!(content.is_empty(), "a bundle is longer than its sections");
            let stored = rest
                .split_off(..stored_bytes)
                .context("a bundle is cut off")?;
            let sharing = table[index + 1..].iter();
            let sharing = sharing.take_while(|entry| entry.bundle.is_none());
            let raw_bytes = sharing.map(|entry| entry.raw_bytes).sum::<usize>() + entry.raw_bytes;
            content = unpack(codec, stored, raw_bytes)?;
        }
        ensure!(content.len() >= entry.raw_bytes, "a bundle is too short");
        let behind = content.split_off(entry.raw_bytes);
        add(&mut sections, &entry.tag, entry.flags & 1 != 0, &content);
        content = behind;
    }
    Ok(sections)
}

fn add(sections: &mut Sections, tag: &str, critical: bool, raw: &[u8]) {
    let number = sections.keys().filter(|name| name.tag == tag).count();
    let name = Name {
        tag: tag.to_owned(),
        number,
    };
    let raw = raw.to_vec();
    sections.insert(name, Content { critical, raw });
}

fn entry(bytes: &mut &[u8]) -> Result<Entry> {
    const CUT_OFF: &str = "the table is cut off";
    let section = bytes.split_off(..SECTION_BYTES).context(CUT_OFF)?;
    let flags = section[4];
    let mut bundle = None;
    if flags & FLAG_SHARED == 0 {
        let head = bytes.split_off(..BUNDLE_BYTES).context(CUT_OFF)?;
        bundle = Some((head[0], number(&mut &head[1..])?));
    }
    Ok(Entry {
        tag: String::from_utf8_lossy(&section[..4]).into_owned(),
        flags,
        raw_bytes: number(&mut &section[5..])?,
        bundle,
    })
}

fn unpack(codec: u8, stored: &[u8], raw_bytes: usize) -> Result<Vec<u8>> {
    let raw = match codec {
        0 => stored.to_vec(),
        1 => zstd::bulk::decompress(stored, raw_bytes).context("a bundle does not unpack")?,
        other => anyhow::bail!("codec {other}"),
    };
    ensure!(raw.len() == raw_bytes, "a bundle has another length");
    Ok(raw)
}

/// Takes a little-endian number of four bytes from the front.
fn number(bytes: &mut &[u8]) -> Result<usize> {
    let number = bytes.split_off(..4).context("a number is cut off")?;
    Ok(usize::try_from(u32::from_le_bytes(number.try_into()?))?)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A file of sections of one byte, of which those in the same bundle follow each other: tag,
    /// number of the bundle, byte.
    pub(crate) fn file(sections: &[(&str, u8, u8)]) -> Vec<u8> {
        let mut bytes = [&MAGIC[..], &[2, 0, 0, 0]].concat();
        bytes.extend(u32::try_from(sections.len()).unwrap().to_le_bytes());
        bytes.resize(HEADER_BYTES, 0);
        for (index, &(tag, bundle, _)) in sections.iter().enumerate() {
            let shared = index > 0 && sections[index - 1].1 == bundle;
            bytes.extend(tag.as_bytes());
            bytes.extend([if shared { FLAG_SHARED } else { 0 }, 1, 0, 0, 0]);
            if !shared {
                let count = sections.iter().filter(|other| other.1 == bundle).count();
                let mut head = [0; BUNDLE_BYTES];
                head[1] = u8::try_from(count).unwrap();
                bytes.extend(head);
            }
        }
        bytes.extend(sections.iter().map(|section| section.2));
        bytes
    }

    #[test]
    fn what_is_stored_otherwise_is_the_same() {
        let listed = [("META", 0, 1), ("TILE", 1, 2), ("TILE", 2, 3)];
        let before = sections(&file(&listed)).unwrap();
        let names: Vec<String> = before.keys().map(Name::to_string).collect();
        assert_eq!(names, ["HEAD", "META", "TILE 0", "TILE 1"]);
        let together = listed.map(|(tag, _, byte)| (tag, 0, byte));
        assert_eq!(sections(&file(&together)).unwrap(), before);
        let mut other = file(&listed);
        *other.last_mut().unwrap() += 1;
        assert_ne!(sections(&other).unwrap(), before, "a byte");
        let mut other = file(&listed);
        other[HEADER_BYTES + 4] |= 1;
        assert_ne!(sections(&other).unwrap(), before, "a flag");
    }

    #[test]
    fn bundles_are_unpacked() {
        let raw = [7; 300];
        let mut packed = file(&[("META", 0, 1)]);
        packed.pop();
        let frame = zstd::bulk::compress(&raw, 3).unwrap();
        packed[HEADER_BYTES + 5..][..2].copy_from_slice(&300_u16.to_le_bytes());
        packed[HEADER_BYTES + SECTION_BYTES] = 1;
        packed[HEADER_BYTES + SECTION_BYTES + 1] = u8::try_from(frame.len()).unwrap();
        packed.extend(frame);
        let read = sections(&packed).unwrap();
        assert!(read.values().any(|content| content.raw == raw));
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let good = file(&[("META", 0, 1), ("META", 1, 1)]);
        assert!(sections(&good).is_ok());
        assert!(sections(&good[..good.len() - 1]).is_err(), "cut off");
        assert!(sections(&good[1..]).is_err(), "no magic");
        let mut old = good;
        old[8] = 1;
        assert!(sections(&old).is_err(), "version 1");
    }
}
