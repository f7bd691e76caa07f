//! Value to bytes and back is the identity, and the bytes are always the same.

use std::sync::Arc;

use vtex_format::{Codec, LayerRecord, Limits, Tag, VtexFile, directory, validate};

use crate::forge::{put_together, take_apart};
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
fn equal_texels_are_stored_once() {
    let mut file = sample::small();
    let mut twin = file.images[1].clone();
    twin.rect_uv = [0.5, 0.5, 0.75, 1.0];
    // Equal, but not yet the same.
    twin.mips = Arc::new(Vec::clone(&twin.mips));
    file.images.push(twin);
    round_trip(&file);
    let bytes = file.to_bytes().unwrap();
    let [_, image, twin] = VtexFile::parse(&bytes, &Limits::default())
        .unwrap()
        .images
        .try_into()
        .unwrap();
    assert!(Arc::ptr_eq(&image.mips, &twin.mips));
    let sections = directory(&bytes, &Limits::default()).unwrap().sections;
    let levels = sections.iter().filter(|section| section.tag == Tag::MIPS);
    assert_eq!(levels.count(), 3, "as many as without the second");
}

#[test]
fn an_image_may_end_before_one_texel() {
    let mut file = sample::small();
    Arc::make_mut(&mut file.images[1].mips).truncate(1);
    round_trip(&file);
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
fn a_loader_may_do_without_lists() {
    let file = sample::outlined();
    let limits = Limits::default();
    let read = |bytes: &[u8], suffices: bool| {
        let mut shown = 0;
        let read = VtexFile::parse_unless(bytes, &limits, &mut |file| {
            assert!(file.cells.is_empty() && file.curves.is_empty());
            shown += 1;
            suffices
        });
        (read, shown)
    };
    let bytes = file.to_bytes().unwrap();
    let without = VtexFile {
        shapes: Vec::new(),
        cells: Vec::new(),
        entries: Vec::new(),
        curves: Vec::new(),
        outlines: None,
        provenance: None,
        ..file.clone()
    };
    assert_eq!(read(&bytes, true), (Ok(without.clone()), 1));
    assert_eq!(read(&bytes, false), (Ok(file.clone()), 1));
    // Of outlines that are not read it is not known whether they are sound.
    let mut sections = take_apart(&bytes);
    let outlines = sections.iter_mut().find(|section| section.tag == *b"OUTL");
    outlines.unwrap().refill(&[0; 8]);
    let broken = put_together(&sections);
    assert_eq!(read(&broken, true), (Ok(without), 1));
    let (refused, _) = read(&broken, false);
    assert_eq!(refused.unwrap_err().issue().code, 5021);
    // What lookups need is checked before.
    let mut sections = take_apart(&bytes);
    let tiles = sections.iter_mut().find(|section| section.tag == *b"TILE");
    tiles.unwrap().refill(&[0; 3]);
    let (refused, shown) = read(&put_together(&sections), true);
    assert_eq!((refused.unwrap_err().issue().code, shown), (6004, 0));
    // A file without fine cells is read as a whole.
    let plain = VtexFile {
        fine: Vec::new(),
        ..file
    };
    assert_eq!(read(&plain.to_bytes().unwrap(), true), (Ok(plain), 0));
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
        Tag::PROV,
        Tag::PANT,
        Tag::GRAD,
        Tag::SHAP,
        Tag::LAYR,
        Tag::IMAG,
        Tag::CELL,
        Tag::ENTR,
        Tag::CURV,
        Tag::SHDR,
        Tag::FINE,
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
        .map(|section| section.raw_bytes / 4)
        .collect();
    // 70 x 1 has one level of more than 64 texels, and 35, 18, 9, 5, 3, 2, 1. 1 x 2 has 2 and 1.
    assert_eq!(levels, [73, 3, 70]);
}

#[test]
fn what_shrinks_is_packed_and_what_is_large_has_a_bundle_of_its_own() {
    let mut file = sample::small();
    let packed = |file: &VtexFile| {
        let bytes = file.to_bytes().unwrap();
        let directory = directory(&bytes, &Limits::default()).unwrap();
        let bundles = directory.bundles.iter();
        let name = |bundle| directory.bundle_sections(bundle)[0].tag;
        let found: Vec<_> = bundles
            .map(|bundle| (name(bundle), bundle.section_count, bundle.codec))
            .collect();
        found
    };
    assert_eq!(packed(&file), [(Tag::META, 17, Codec::Zstd)]);
    let noise = |i: u32| {
        u32::from_le_bytes(
            blake3::hash(&i.to_le_bytes()).as_bytes()[..4]
                .try_into()
                .unwrap(),
        )
    };
    file.shader.batch_spirv = (0..10_000).map(noise).collect();
    let [records, shader, texels] = packed(&file).try_into().unwrap();
    assert_eq!(records, (Tag::META, 11, Codec::Zstd));
    assert_eq!(shader, (Tag::SHDR, 1, Codec::Raw));
    assert_eq!(texels, (Tag::FINE, 5, Codec::Zstd));
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
        .map(|section| section.raw_bytes / 27)
        .collect();
    assert_eq!(parts, [130_000, 50_000]);
    assert_eq!(VtexFile::parse(&bytes, &Limits::default()).unwrap(), file);
}
