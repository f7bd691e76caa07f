//! Constants and records that cross from Rust into WGSL, compared through naga in every linked
//! variant: names, values, offsets, spans.

use std::collections::BTreeMap;

use naga::{Expression, Literal, Module, TypeInner};
use vtex_format::{Features, SpecKey};
use vtex_shaders::layout::{BATCH_QUERY, CONSTANTS, RecordLayout, rows};
use vtex_shaders::set::{
    self, QUEUE_PART, TEXTURE_QUERY, queue_arguments_kernel, queue_kernel, queue_order_kernels,
    queue_pool_kernel, set_fragment,
};
use vtex_shaders::{BindingSlot, batch_kernel, scene_evaluator};

fn key(features: u32) -> SpecKey {
    SpecKey { features }
}

/// Numbers that are no integers; tests of parity hold them against Rust's.
const FLOATS: [&str; 13] = [
    "VTEX_ROWS_LEAST",
    "VTEX_ROWS_SLACK",
    "VTEX_SAMPLES_SLACK",
    "VTEX_LOOKUP_MOST",
    "VTEX_MAPPING_LEAST_EXTENT",
    "VTEX_MAPPING_LEAST_UNITS",
    "VTEX_ROWS_ROW",
    "VTEX_ROWS_COLUMN",
    "VTEX_PICTURE_FAR",
    "VTEX_PICTURE_OVERLAP",
    "VTEX_PICTURE_WIDTHS",
    "VTEX_PICTURE_INSIDE",
    "VTEX_PICTURE_PART",
];

/// Named constants of a module that are not of its key; all but those of [`FLOATS`] are `u32`.
fn constants(module: &Module) -> BTreeMap<&str, u32> {
    let named = module.constants.iter().filter_map(|(_, constant)| {
        let value = &module.global_expressions[constant.init];
        match (constant.name.as_deref()?, value) {
            (name, Expression::Literal(Literal::U32(value))) => Some((name, *value)),
            (name, _) if FLOATS.contains(&name) => None,
            (name, other) => panic!("{name} is not a plain u32: {other:?}"),
        }
    });
    named
        .filter(|(name, _)| !name.starts_with("VTEX_KEY_"))
        .collect()
}

fn check_constants(module: &Module, features: u32, text: &str, more: &[(&'static str, u32)]) {
    let mut expected: BTreeMap<&str, u32> = CONSTANTS.iter().chain(more).copied().collect();
    // The one constant that depends on the variant: a mask of all samples.
    let footprint = features & Features::FOOTPRINT != 0;
    let samples = if footprint { rows::EVERY } else { 1 };
    expected.insert("VTEX_SAMPLES_EVERY", samples);
    assert_eq!(constants(module), expected, "{text} {features:#b}");
}

fn check_record(module: &Module, record: &RecordLayout) {
    let named = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(record.name));
    let (_, ty) = named.expect("the struct is in the text");
    let TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{} is no struct", record.name);
    };
    let fields: Vec<_> = members
        .iter()
        .map(|m| (m.name.as_deref().unwrap_or(""), m.offset as usize))
        .collect();
    assert_eq!(fields, record.fields, "{}", record.name);
    assert_eq!(*span as usize, record.span_bytes, "{}", record.name);
}

#[test]
fn every_variant_has_the_constants_and_records_of_rust() {
    for features in (0..=Features::ALL).step_by(13).chain([Features::ALL]) {
        let text = batch_kernel(&key(features));
        let module = naga::front::wgsl::parse_str(&text).expect("WGSL");
        check_constants(&module, features, "batch kernel", &[]);
        check_record(&module, &BATCH_QUERY);
        let text = scene_evaluator(features, BindingSlot::default());
        let module = naga::front::wgsl::parse_str(&text).expect("WGSL");
        check_constants(&module, features, "scene", &[]);
    }
}

/// What a set adds does not depend on the variant.
#[test]
fn sets_have_the_constants_and_records_of_rust() {
    for features in [0, Features::FOOTPRINT, Features::ALL] {
        let text = set_fragment(features, BindingSlot::default());
        let module = naga::front::wgsl::parse_str(&text).expect("WGSL");
        check_constants(&module, features, "set", set::CONSTANTS);
        let module = naga::front::wgsl::parse_str(&queue_kernel(features)).expect("WGSL");
        check_constants(&module, features, "queue", set::CONSTANTS);
        check_record(&module, &TEXTURE_QUERY);
        let module = naga::front::wgsl::parse_str(&queue_pool_kernel(features)).expect("WGSL");
        check_constants(&module, features, "part of a queue", set::CONSTANTS);
        check_record(&module, &QUEUE_PART);
    }
}

/// Group, binding and name of what a text binds.
fn bindings(text: &str) -> Vec<(u32, u32, String)> {
    let module = naga::front::wgsl::parse_str(text).expect("WGSL");
    let mut bindings: Vec<_> = module
        .global_variables
        .iter()
        .filter_map(|(_, variable)| {
            let at = variable.binding.as_ref()?;
            Some((at.group, at.binding, variable.name.clone()?))
        })
        .collect();
    bindings.sort_unstable();
    bindings
}

fn check_bindings(text: &str, expected: &[(u32, u32, &str)]) {
    let named = expected
        .iter()
        .map(|&(group, binding, name)| (group, binding, name.to_owned()));
    assert_eq!(bindings(text), named.collect::<Vec<_>>(), "{expected:?}");
}

#[test]
fn bindings_are_where_they_are_said_to_be() {
    check_bindings(
        &batch_kernel(&key(Features::ALL)),
        &[
            (0, 0, "vtex_words"),
            (0, 1, "vtex_texels"),
            (0, 2, "vtex_sampler"),
            (0, 3, "vtex_queries"),
            (0, 4, "vtex_results"),
        ],
    );
    let queue = [
        (0, 0, "vtex_queue_queries"),
        (0, 1, "vtex_queue_count"),
        (0, 2, "vtex_queue_colors"),
    ];
    let set = [
        (1, 0, "vtex_words"),
        (1, 1, "vtex_texels"),
        (1, 2, "vtex_sampler"),
    ];
    check_bindings(&queue_kernel(Features::ALL), &[queue, set].concat());
    let arguments = [(1, 0, "vtex_queue_dispatch")];
    check_bindings(
        &queue_arguments_kernel(),
        &[&queue[..], &arguments].concat(),
    );
    let order = [
        (1, 0, "vtex_queue_tallies"),
        (1, 1, "vtex_queue_parts"),
        (1, 2, "vtex_queue_order"),
    ];
    check_bindings(&queue_order_kernels(), &[&queue[..], &order].concat());
    let ordered = [(2, 0, "vtex_queue_parts"), (2, 1, "vtex_queue_order")];
    check_bindings(
        &queue_pool_kernel(Features::ALL),
        &[&queue[..], &set, &ordered].concat(),
    );
}
