//! Every text that a key can lead to: parses, validates, compiles to SPIR-V that reads back.

use std::io::Write as _;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use rayon::prelude::*;
use vtex_format::{Features, SpecKey};
use vtex_shaders::set::{
    queue_arguments_kernel, queue_kernel, queue_order_kernels, queue_pool_kernel,
};
use vtex_shaders::{BindingSlot, batch_kernel, fragment, scene_evaluator, shader_blob, spirv};
use vtex_tests::variants::variants;

fn validate(module: &naga::Module, what: &str) {
    let capabilities = Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    let result = Validator::new(ValidationFlags::all(), capabilities).validate(module);
    assert!(result.is_ok(), "{what}: {result:?}");
}

#[test]
fn kernels_compile_and_read_back() {
    let variants = variants();
    variants.par_iter().for_each(|variant| {
        let key = variant.key();
        let blob = shader_blob(&key).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let options = naga::front::spv::Options::default();
        let module =
            naga::front::spv::parse_u8_slice(bytemuck::cast_slice(&blob.batch_spirv), &options)
                .unwrap_or_else(|error| panic!("{key:?}: {error:?}"));
        validate(&module, &format!("{key:?}"));
        assert_eq!(module.entry_points[0].name, "vtex_batch");
        assert_eq!(module.entry_points[0].workgroup_size, [64, 1, 1]);
    });
    report("kernels", variants.len());
}

/// What can exist is what ran: every variant is there once.
fn report(what: &str, count: usize) {
    // A report that nobody can read is no failure.
    let _ = writeln!(
        std::io::stderr(),
        "{what}: {count} texts can exist, {count} were validated"
    );
}

/// A shader that calls the evaluator, with its own bindings and entry point.
fn caller(call: &str) -> String {
    format!(
        "@fragment fn main(@location(0) uv: vec2f) -> @location(0) vec4f {{\n    \
         return {call}, vec4f(dpdx(uv), dpdy(uv)));\n}}\n"
    )
}

#[test]
fn fragments_and_scenes_live_in_a_shader_of_another() {
    let slot = BindingSlot {
        group: 2,
        binding: 5,
    };
    let variants = variants();
    variants.par_iter().for_each(|variant| {
        let key = variant.key();
        let text = caller("vtex_sample(uv") + &fragment(&key, slot);
        spirv(&text).unwrap_or_else(|error| panic!("{key:?}: {error}"));
        let text = caller("vtex_sample_at(7u, uv") + &scene_evaluator(key.features, slot);
        spirv(&text).unwrap_or_else(|error| panic!("scene {key:?}: {error}"));
    });
    report("fragments and scenes", variants.len());
}

#[test]
fn queues_of_sets_compile() {
    spirv(&queue_arguments_kernel()).unwrap();
    spirv(&queue_order_kernels()).unwrap();
    let variants = variants();
    variants.par_iter().for_each(|variant| {
        let features = variant.features;
        for text in [queue_kernel(features), queue_pool_kernel(features)] {
            spirv(&text).unwrap_or_else(|error| panic!("{features:#b}: {error}"));
        }
    });
    report("queues", variants.len());
}

#[test]
fn keys_that_no_file_should_have_still_make_a_shader() {
    for bits in [u32::MAX, 1 << 31, 0] {
        let key = SpecKey { features: bits };
        spirv(&batch_kernel(&key)).unwrap();
    }
}

/// Ends of loops. Those over rows go from one clamped number of rows to another.
const BOUNDS: [&str; 7] = [
    "i < 2u; i += 1u",
    "i < VTEX_CMD_LIMIT; i += 1u",
    "i < VTEX_ROWS_SAMPLES; i += 1u",
    "i <= VTEX_ROWS_SAMPLES; i += 1u",
    "row < rows_end; row += 1",
    "i < VTEX_IMAGE_TAPS * VTEX_IMAGE_PLACES; i += 1u",
    "i < VTEX_GRADIENT_SEARCH_STEPS; i += 1u",
];

#[test]
fn loops_are_bounded_by_constants() {
    let optional = [
        Features::FOOTPRINT,
        Features::PAPER,
        Features::GROUPS | Features::BLENDS,
        Features::TRANSLUCENT | Features::IMAGES,
    ];
    for choice in 0..1 << optional.len() {
        let left_out = (0..)
            .zip(optional)
            .filter(|(bit, _)| choice >> bit & 1 != 0);
        let left_out = left_out.fold(0, |all, (_, features)| all | features);
        check_loops(Features::ALL & !left_out);
    }
}

fn check_loops(features: u32) {
    let text = batch_kernel(&SpecKey { features });
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
}
