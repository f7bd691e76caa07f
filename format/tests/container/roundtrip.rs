//! Value to bytes and back is the identity, and the bytes are always the same.

use vtex_format::{Codec, LayerRecord, Limits, Tag, VtexFile, directory, validate};

use crate::sample;

fn round_trip(file: &VtexFile) {
    assert_eq!(file.check(), [], "the sample must be valid");
    let bytes = file.to_bytes().unwrap();
    assert_eq!(
        validate(&bytes, &Limits::default()),
        [],
        "what is written is valid"
    );
    let read = VtexFile::parse(&bytes, &Limits::default()).unwrap();
    assert_eq!(&read, file, "read back");
    assert_eq!(read.to_bytes().unwrap(), bytes, "same value, same bytes");
}

#[test]
fn a_file_with_every_section() {
    round_trip(&sample::small());
}

#[test]
fn a_file_with_outlines_instead_of_records() {
    round_trip(&sample::outlined());
    let bytes = sample::outlined().to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let has = |tag| directory.sections.iter().any(|section| section.tag == tag);
    assert!(has(Tag::OUTL) && !has(Tag::CURV));
}

#[test]
fn outlines_and_records_give_the_same_lookups() {
    let outlined = sample::outlined();
    let plain = VtexFile {
        outlines: None,
        ..outlined.clone()
    };
    let read = |file: &VtexFile| VtexFile::parse(&file.to_bytes().unwrap(), &Limits::default());
    assert_eq!(
        read(&outlined).unwrap().curves,
        read(&plain).unwrap().curves
    );
}

#[test]
fn arbitrary_files() {
    arbtest::arbtest(|u| {
        round_trip(&sample::arbitrary(u)?);
        Ok(())
    })
    .budget_ms(2_000);
}

#[test]
fn every_tag_is_there_in_file_order() {
    let bytes = sample::small().to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let mut tags: Vec<Tag> = directory
        .sections
        .iter()
        .map(|section| section.tag)
        .collect();
    tags.dedup();
    let expected = [
        Tag::META,
        Tag::SPEC,
        Tag::SHDR,
        Tag::PROV,
        Tag::PANT,
        Tag::GRAD,
        Tag::SHAP,
        Tag::LAYR,
        Tag::IMAG,
        Tag::CELL,
        Tag::ENTR,
        Tag::CURV,
        Tag::TILE,
        Tag::MIPS,
    ];
    assert_eq!(tags, expected);
    assert_eq!(directory.file_bytes, bytes.len() as u64);
}

#[test]
fn coarse_levels_of_all_images_come_first() {
    let bytes = sample::small().to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let levels: Vec<_> = directory
        .sections
        .iter()
        .filter(|section| section.tag == Tag::MIPS)
        .map(|section| (section.mip, section.image, section.raw_bytes))
        .collect();
    // 5 x 3 has levels 5x3, 2x1, 1x1; 1 x 2 has 1x2, 1x1.
    assert_eq!(
        levels,
        [(2, 0, 4), (1, 0, 8), (1, 1, 4), (0, 0, 60), (0, 1, 8)]
    );
}

#[test]
fn what_shrinks_is_packed_and_what_does_not_is_not() {
    let mut file = sample::small();
    file.shader.wgsl_fragment = "let zero = 0.0;\n".repeat(100);
    let bytes = file.to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let codec = |tag| {
        let section = directory.sections.iter().find(|section| section.tag == tag);
        section.unwrap().codec
    };
    assert_eq!(codec(Tag::SHDR), Codec::Zstd);
    assert_eq!(codec(Tag::CELL), Codec::Raw);
}

#[test]
fn many_tiles_are_split_at_layers() {
    let mut file = sample::small();
    // 9 texels a tile, 36 bytes in memory: 60,000 and 70,000 tiles are 2.2 and 2.5 MB.
    let counts = [60_000, 70_000, 50_000];
    let mut tile_first = 0;
    file.layers = counts
        .map(|tile_count| {
            let layer = LayerRecord {
                tile_first,
                tile_count,
                shape_count: 0,
                reserved: 0,
            };
            tile_first += tile_count;
            layer
        })
        .to_vec();
    file.shapes.clear();
    file.provenance = None;
    file.tiles = [9, 8, 7, 255].repeat(9 * tile_first as usize);
    let bytes = file.to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let parts: Vec<_> = directory
        .sections
        .iter()
        .filter(|section| section.tag == Tag::TILE)
        .map(|section| {
            (
                section.layer_first,
                section.layer_count,
                section.raw_bytes / 27,
            )
        })
        .collect();
    assert_eq!(parts, [(0, 2, 130_000), (2, 1, 50_000)]);
    assert_eq!(VtexFile::parse(&bytes, &Limits::default()).unwrap(), file);
}
