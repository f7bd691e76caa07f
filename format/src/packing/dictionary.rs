//! Dictionaries: shaders that this library knows, to which frames of others may refer back.
//!
//! A *store* is a file of dictionaries beside this one. Its bytes are, for each dictionary: its id, the
//! length of its content, the length of a zstd frame, and the frame. The content is the raw bytes of
//! a `SHDR`. The first dictionary of a store is the *base*: frames of the others refer back to it.
//! `cargo run --release -p vtex-shaders --features precompile --example shader_dictionaries` makes
//! the newest store.

use std::sync::OnceLock;

/// All stores, the newest last. Writers use the newest. A store that a released version wrote with
/// stays, so that its files can be read.
const STORES: [&[u8]; 1] = [include_bytes!("shaders-5.bin")];

/// Bytes of an id.
pub(super) const ID_BYTES: usize = 4;

/// First bytes of the blake3 hash of a dictionary's content.
type Id = [u8; ID_BYTES];

/// A dictionary, unpacked when it is first asked for.
struct Dictionary {
    id: Id,
    raw_bytes: usize,
    frame: &'static [u8],
    /// Index of the base of its store, unless it is the base.
    base: Option<usize>,
    content: OnceLock<Option<Vec<u8>>>,
}

/// The dictionaries of all stores.
fn all() -> &'static [Dictionary] {
    static ALL: OnceLock<Vec<Dictionary>> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut all = Vec::new();
        for store in STORES {
            read_store(store, &mut all);
        }
        all
    })
}

/// Appends the dictionaries of a store. One that is not whole ends where it is broken.
fn read_store(mut store: &'static [u8], all: &mut Vec<Dictionary>) {
    let base = all.len();
    while let Some((dictionary, rest)) = read_dictionary(store) {
        let base = (all.len() > base).then_some(base);
        all.push(Dictionary { base, ..dictionary });
        store = rest;
    }
}

fn read_dictionary(bytes: &'static [u8]) -> Option<(Dictionary, &'static [u8])> {
    let (&id, rest) = bytes.split_first_chunk()?;
    let (&raw_bytes, rest) = rest.split_first_chunk()?;
    let (&frame_bytes, rest) = rest.split_first_chunk()?;
    let length = |bytes| usize::try_from(u32::from_le_bytes(bytes)).ok();
    let (frame, rest) = rest.split_at_checked(length(frame_bytes)?)?;
    let dictionary = Dictionary {
        id,
        raw_bytes: length(raw_bytes)?,
        frame,
        base: None,
        content: OnceLock::new(),
    };
    Some((dictionary, rest))
}

impl Dictionary {
    /// The content; `None` when the store is damaged, which a test rules out.
    fn content(&'static self) -> Option<&'static [u8]> {
        let unpack = || {
            let base = match self.base {
                Some(base) => all().get(base)?.content()?,
                None => &[],
            };
            unpacked(self.frame, base, self.raw_bytes)
        };
        self.content.get_or_init(unpack).as_deref()
    }
}

/// The content of the dictionary with this id.
#[cfg(feature = "decode")]
pub(super) fn find(id: Id) -> Option<&'static [u8]> {
    all()
        .iter()
        .find(|dictionary| dictionary.id == id)?
        .content()
}

/// Raw bytes of a frame of a store.
#[cfg(any(feature = "encode", feature = "zstd"))]
fn unpacked(frame: &[u8], base: &[u8], raw_bytes: usize) -> Option<Vec<u8>> {
    let mut decoder = zstd::bulk::Decompressor::with_dictionary(base).ok()?;
    decoder.decompress(frame, raw_bytes).ok()
}

/// Raw bytes of a frame of a store.
#[cfg(not(any(feature = "encode", feature = "zstd")))]
fn unpacked(frame: &[u8], base: &[u8], raw_bytes: usize) -> Option<Vec<u8>> {
    let frame = super::zstd_frame::Frame::parse(frame).ok()?;
    let mut raw = vec![0; raw_bytes];
    super::unpack::ruzstd_decoder::decode(&frame, base, &mut raw)?;
    Some(raw)
}

#[cfg(feature = "encode")]
pub(super) use writing::pack;
#[cfg(feature = "encode")]
pub use writing::shader_dictionaries;

#[cfg(feature = "encode")]
mod writing {
    use std::io;

    use zstd::bulk::Compressor;

    use super::{Dictionary, ID_BYTES, Id, all};
    use crate::records::shader::ShaderBlob;

    /// zstd level that finds out which dictionary suits a shader. Of one that a dictionary holds nearly
    /// all is one match, which any level finds.
    const FIRST_LEVEL: i32 = 3;
    /// A shader that takes less than one part in so many is taken for known.
    const KNOWN_SHARE: usize = 50;
    /// zstd level of other shaders. Higher ones take most of their time to take in the dictionary.
    const OTHER_LEVEL: i32 = 9;
    /// zstd level of stores, which are made once.
    const STORE_LEVEL: i32 = 22;

    /// The raw bytes of `SHDR` as stored: the id of a dictionary of the newest store, and a frame. A
    /// shader that no dictionary holds has the one that suits it better: the base, which has most of
    /// the text's modules, or the one whose length is the nearest.
    ///
    /// `None` where dictionaries do not make it shorter.
    ///
    /// # Errors
    /// When zstd has no memory.
    pub(in crate::packing) fn pack(raw: &[u8]) -> io::Result<Option<Vec<u8>>> {
        let all = all();
        let newest = all.iter().rposition(|dictionary| dictionary.base.is_none());
        let newest = &all[newest.unwrap_or(all.len())..];
        let distance = |dictionary: &&'static Dictionary| dictionary.raw_bytes.abs_diff(raw.len());
        let (Some(base), Some(nearest)) = (newest.first(), newest.iter().min_by_key(distance))
        else {
            return Ok(None);
        };
        let is_known = |stored: &Vec<u8>| KNOWN_SHARE * stored.len() < raw.len();
        let first = stored(raw, nearest, FIRST_LEVEL)?;
        if first.as_ref().is_some_and(is_known) {
            return Ok(first);
        }
        let length = |stored: Option<Vec<u8>>| stored.map_or(usize::MAX, |stored| stored.len());
        let better = match length(stored(raw, base, FIRST_LEVEL)?) < length(first) {
            true => base,
            false => nearest,
        };
        let stored = stored(raw, better, OTHER_LEVEL)?;
        Ok(stored.filter(|stored| stored.len() < raw.len()))
    }

    fn stored(
        raw: &[u8],
        dictionary: &'static Dictionary,
        level: i32,
    ) -> io::Result<Option<Vec<u8>>> {
        let Some(content) = dictionary.content() else {
            return Ok(None);
        };
        let frame = Compressor::with_dictionary(level, content)?.compress(raw)?;
        Ok(Some([&dictionary.id[..], &frame].concat()))
    }

    /// A store of dictionaries with these shaders, the base first, as it lies in
    /// `format/src/packing/`. Only the example that makes it needs this.
    ///
    /// # Errors
    /// When zstd has no memory.
    ///
    /// # Panics
    /// For a shader of 4 GiB.
    #[doc(hidden)]
    pub fn shader_dictionaries(shaders: &[ShaderBlob]) -> io::Result<Vec<u8>> {
        let mut store = Vec::new();
        let mut base = Vec::new();
        for shader in shaders {
            let content = shader.encode().expect("shaders are small");
            let frame = Compressor::with_dictionary(STORE_LEVEL, &base)?.compress(&content)?;
            let id: Id = std::array::from_fn(|i| blake3::hash(&content).as_bytes()[i]);
            store.extend_from_slice(&id);
            for length in [content.len(), frame.len()] {
                let length = u32::try_from(length).expect("shaders are small");
                store.extend_from_slice(&length.to_le_bytes());
            }
            store.extend_from_slice(&frame);
            if base.is_empty() {
                base = content;
            }
        }
        Ok(store)
    }

    const _: () = assert!(ID_BYTES <= blake3::OUT_LEN, "an id is a part of a hash");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stores_are_whole_and_ids_are_hashes() {
        let all = all();
        let entry = ID_BYTES + 8;
        let bytes: usize = all.iter().map(|found| entry + found.frame.len()).sum();
        let stores: usize = STORES.iter().map(|store| store.len()).sum();
        assert_eq!(bytes, stores);
        for (index, dictionary) in all.iter().enumerate() {
            let content = dictionary.content().expect("the frame unpacks");
            assert_eq!(content.len(), dictionary.raw_bytes);
            assert!(blake3::hash(content).as_bytes().starts_with(&dictionary.id));
            // zstd would take it for a dictionary with tables of its own.
            assert!(!content.starts_with(&0xEC30_A437_u32.to_le_bytes()));
            let twice = all[..index].iter().any(|other| other.id == dictionary.id);
            assert!(!twice, "two dictionaries with one id");
        }
    }

    #[test]
    fn a_shader_that_a_dictionary_holds_takes_a_few_bytes() {
        let known = all().last().and_then(Dictionary::content).unwrap();
        let stored = pack(known).unwrap().unwrap();
        assert!(stored.len() < 60, "{}", stored.len());
        assert_eq!(pack(&[1, 2, 3]).unwrap(), None);
    }
}
