//! Bundles that refer to a dictionary.

use vtex_format::{Codec, Limits, Tag, VtexFile, directory, validate};
use zstd::bulk::Compressor;
use zstd::zstd_safe::CParameter;

use crate::forge::{put_together, take_apart};
use crate::sample;

/// The newest store, by the words of `docs/format.md` and not by the crate's own.
const STORE: &[u8] = include_bytes!("../../src/packing/shaders-5.bin");

/// Its first dictionary.
pub(crate) struct Base {
    pub(crate) id: [u8; 4],
    pub(crate) content: Vec<u8>,
}

impl Base {
    pub(crate) fn new() -> Self {
        let word = |at: usize| u32::from_le_bytes(STORE[at..at + 4].try_into().unwrap()) as usize;
        let (raw, stored) = (word(4), word(8));
        Self {
            id: STORE[..4].try_into().unwrap(),
            content: zstd::bulk::decompress(&STORE[12..12 + stored], raw).unwrap(),
        }
    }

    /// Stored bytes of codec 2.
    pub(crate) fn packed(&self, raw: &[u8], checksum: bool) -> Vec<u8> {
        let mut compressor = Compressor::with_dictionary(3, &self.content).unwrap();
        let flag = CParameter::ChecksumFlag(checksum);
        compressor.set_parameter(flag).unwrap();
        [&self.id[..], &compressor.compress(raw).unwrap()].concat()
    }
}

/// A file whose shader is the first dictionary.
fn known() -> VtexFile {
    let content = Base::new().content;
    let word = |at: usize| u32::from_le_bytes(content[at..at + 4].try_into().unwrap()) as usize;
    let text = 16..16 + word(4);
    let mut file = sample::small();
    file.shader.abi = word(0) as u32;
    let spirv = &content[text.end.next_multiple_of(4)..];
    file.shader.wgsl_fragment = String::from_utf8(content[text].to_vec()).unwrap();
    file.shader.batch_spirv = spirv
        .chunks_exact(4)
        .map(|word| u32::from_le_bytes(word.try_into().unwrap()))
        .collect();
    file
}

#[test]
fn a_known_shader_takes_a_few_bytes() {
    let file = known();
    let bytes = file.to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let tag = |bundle| directory.bundle_sections(bundle)[0].tag;
    let shader = directory
        .bundles
        .iter()
        .find(|bundle| tag(bundle) == Tag::SHDR);
    let shader = shader.unwrap();
    assert_eq!(shader.codec, Codec::Dictionary);
    assert!(shader.stored_bytes < 60, "{}", shader.stored_bytes);
    assert_eq!(VtexFile::parse(&bytes, &Limits::default()).unwrap(), file);
}

#[test]
fn any_section_may_refer_to_a_dictionary() {
    let file = sample::small();
    let base = Base::new();
    let mut sections = take_apart(&file.to_bytes().unwrap());
    for section in &mut sections {
        let content = section.content();
        section.codec = 2;
        section.stored = base.packed(&content, false);
    }
    let bytes = put_together(&sections);
    assert_eq!(VtexFile::parse(&bytes, &Limits::default()).unwrap(), file);
}

#[test]
fn damage_behind_a_dictionary_is_found() {
    let file = known();
    let bytes = file.to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let bundle = directory
        .bundles
        .iter()
        .find(|b| b.codec == Codec::Dictionary);
    let bundle = bundle.unwrap();
    let start = bundle.offset_bytes as usize;
    for at in start..start + bundle.stored_bytes as usize {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            let issues = validate(&damaged, &Limits::default());
            let codes: Vec<u16> = issues.iter().map(|issue| issue.code).collect();
            let expected: &[u16] = match at - start {
                0..4 => &[2023],
                _ => &[2017, 2018],
            };
            // Some bits of a frame mean nothing to some decoders.
            let harmless = codes.is_empty()
                && VtexFile::parse(&damaged, &Limits::default()).is_ok_and(|read| read == file);
            let found = codes.len() == 1 && expected.contains(&codes[0]);
            assert!(found || harmless, "{at} {bit}: {codes:?}");
        }
    }
}
