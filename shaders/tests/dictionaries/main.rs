//! The dictionaries that `vtex-format` ships fit the shaders as they are now.

#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use vtex_format::{
    Codec, Features, Grid, Limits, Meta, SamplerSettings, SpecKey, Tag, VtexFile, directory,
};
use vtex_shaders::{dictionary_keys, shader_blob};

/// Most bytes of a shader that is a dictionary, up to a number in its text.
const KNOWN_BYTES: u64 = 400;
/// Most bytes of another shader, whose text but not whose SPIR-V is in a dictionary.
const OTHER_BYTES: u64 = 15_000;

const REMAKE: &str = "The shaders have changed: make their dictionaries again with `cargo run \
    --release -p vtex-shaders --features precompile --example shader_dictionaries`";

/// Bytes of `SHDR` in a file whose shader is that of `features`.
fn stored_bytes(features: u32) -> u64 {
    let key = SpecKey { features };
    let mut file = VtexFile::blank(meta());
    file.shader = shader_blob(&key).unwrap();
    let bytes = file.to_bytes().unwrap();
    let directory = directory(&bytes, &Limits::default()).unwrap();
    let shader = directory.bundles.iter().find(|bundle| {
        let sections = directory.bundle_sections(bundle);
        sections.iter().any(|section| section.tag == Tag::SHDR)
    });
    let shader = shader.unwrap();
    assert_eq!(shader.codec, Codec::Dictionary, "{features:#x}");
    let read = VtexFile::parse(&bytes, &Limits::default()).unwrap();
    assert_eq!(read, file, "{features:#x}");
    shader.stored_bytes
}

fn meta() -> Meta {
    Meta {
        canvas_size: [1.0; 2],
        grid: Grid {
            size_cells: [1; 2],
            cell_from_uv_scale: [1.0; 2],
            cell_from_uv_offset: [0.0; 2],
            texels_per_cell: 1,
        },
        distance_range_texels: 4.0,
        max_zoom: 1.0,
        curve_lattice: None,
        sampler: SamplerSettings::default(),
    }
}

#[test]
fn known_shaders_take_a_few_bytes() {
    for key in dictionary_keys() {
        // Neither changes more than the number of the features.
        for more in [0, Features::DEEP_GROUPS] {
            let bytes = stored_bytes(key.features | more);
            let features = key.features | more;
            assert!(
                bytes <= KNOWN_BYTES,
                "{features:#x}: {bytes} bytes. {REMAKE}"
            );
        }
    }
}

#[test]
fn others_take_less_than_without() {
    let curves = Features::LISTS | Features::CURVES;
    for features in [
        curves | Features::MAPPING,
        curves | Features::CLIPS | Features::TRANSLUCENT,
        curves | Features::MAPPING | Features::GRADIENTS | Features::GROUPS,
        Features::LISTS | Features::MSDF,
        Features::LISTS | Features::MSDF | Features::OUTLINE | Features::TRANSLUCENT,
    ] {
        let bytes = stored_bytes(features);
        assert!(
            bytes <= OTHER_BYTES,
            "{features:#x}: {bytes} bytes. {REMAKE}"
        );
    }
}
