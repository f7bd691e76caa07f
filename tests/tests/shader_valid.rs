//! Every text that a key can lead to: parses, validates, compiles to SPIR-V that reads back.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use rayon::prelude::*;
use vtex_format::{AddressMode, Features, MAX_ENTRIES_PER_CELL, MAX_FRAMES, SHADER_ABI, SpecKey};
use vtex_shaders::{BindingSlot, batch_kernel, fragment, scene_evaluator, shader_blob, spirv};

/// One feature combination in thirteen, so that any few features meet in every state, each with one
/// of the sixteen pairs of address modes.
fn keys() -> impl ParallelIterator<Item = SpecKey> {
    let sets: Vec<u32> = (0..=Features::ALL)
        .step_by(13)
        .chain([Features::ALL])
        .collect();
    let mode = |bits: u32| AddressMode::ALL[(bits & 3) as usize];
    sets.into_par_iter().map(move |features| SpecKey {
        abi: SHADER_ABI,
        features,
        address_u: mode(features ^ (features >> 4)),
        address_v: mode((features >> 2) ^ (features >> 6)),
        texels_per_cell: 1 + features % 32,
        max_entries: 1 + features % MAX_ENTRIES_PER_CELL,
        frames: 1 + features % MAX_FRAMES,
        reserved: 0,
    })
}

fn validate(module: &naga::Module, what: &str) {
    let capabilities = Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    let result = Validator::new(ValidationFlags::all(), capabilities).validate(module);
    assert!(result.is_ok(), "{what}: {result:?}");
}

#[test]
fn kernels_compile_and_read_back() {
    keys().for_each(|key| {
        let blob = shader_blob(&key).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        assert_eq!(blob, shader_blob(&key).unwrap(), "{key:?}");
        let options = naga::front::spv::Options::default();
        let module =
            naga::front::spv::parse_u8_slice(bytemuck::cast_slice(&blob.batch_spirv), &options)
                .unwrap_or_else(|error| panic!("{key:?}: {error:?}"));
        validate(&module, &format!("{key:?}"));
        assert_eq!(module.entry_points[0].name, "vtex_batch");
        assert_eq!(module.entry_points[0].workgroup_size, [64, 1, 1]);
    });
}

#[test]
fn fragments_and_scenes_live_in_a_shader_of_another() {
    let shader = |call: &str| {
        format!(
            "@fragment fn main(@location(0) uv: vec2f) -> @location(0) vec4f {{\n    \
             return {call}, vec4f(dpdx(uv), dpdy(uv)));\n}}\n"
        )
    };
    keys().for_each(|key| {
        let slot = BindingSlot {
            group: 2,
            binding: 5,
        };
        let text = shader("vtex_sample(uv") + &fragment(&key, slot);
        spirv(&text).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let text = shader("vtex_sample_at(7u, uv") + &scene_evaluator(key.features, slot);
        spirv(&text).unwrap_or_else(|error| panic!("scene {key:?}: {error}"));
    });
}

#[test]
fn keys_that_no_file_should_have_still_make_a_shader() {
    for bits in [u32::MAX, 1 << 31, 0] {
        let key = SpecKey {
            abi: bits,
            features: bits,
            address_u: AddressMode::Border,
            address_v: AddressMode::Border,
            texels_per_cell: bits,
            max_entries: bits,
            frames: bits,
            reserved: bits,
        };
        spirv(&batch_kernel(&key)).unwrap();
    }
}

/// Ends of loops.
const BOUNDS: [&str; 7] = [
    "i < VTEX_KEY_FRAMES; i += 1u",
    "i < VTEX_KEY_MAX_ENTRIES; i += 1u",
    "i < 2u * VTEX_KEY_MAX_ENTRIES; i += 1u",
    "i < VTEX_ITEM_LIMIT; i += 1u",
    "i < VTEX_CURVE_NEWTON_STEPS; i++",
    "i < VTEX_IMAGE_TAPS; i += 1u",
    "i < VTEX_GRADIENT_SEARCH_STEPS; i += 1u",
];

#[test]
fn loops_are_bounded_by_constants() {
    let ramps = Features::ALL & !Features::MASK;
    let scoped = Features::CLIPS | Features::GROUPS | Features::BLENDS;
    let points = ramps & !(Features::RAMPS | Features::OUTLINE);
    let clips = points & !scoped | Features::CLIPS;
    for features in [ramps, points, ramps & !scoped, points & !scoped, clips] {
        check_loops(features);
    }
}

fn check_loops(features: u32) {
    let key = SpecKey {
        abi: SHADER_ABI,
        features,
        address_u: AddressMode::Repeat,
        address_v: AddressMode::Repeat,
        texels_per_cell: 8,
        max_entries: u32::MAX,
        frames: 0,
        reserved: 0,
    };
    let text = batch_kernel(&key);
    let loops: Vec<&str> = text
        .lines()
        .filter(|line| line.trim_start().starts_with("for "))
        .collect();
    assert!(!loops.is_empty(), "lists are walked in loops");
    for line in loops {
        let bounded = BOUNDS.iter().any(|bound| line.contains(bound));
        assert!(bounded, "{line}");
    }
    assert!(
        !text.contains("while ") && !text.contains("loop {"),
        "no other loops"
    );
    let most = format!("VTEX_KEY_MAX_ENTRIES: u32 = {MAX_ENTRIES_PER_CELL}u;");
    assert!(text.contains(&most), "keys are cut to the format's limit");
}
