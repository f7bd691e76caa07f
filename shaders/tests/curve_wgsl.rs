//! The WGSL of curve records is valid and holds the numbers of the format.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use vtex_format::{MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS};

const PRELUDE: &str = "
@group(0) @binding(0) var<storage, read> vtex_words: array<u32>;
@group(0) @binding(1) var<storage, read_write> results: array<f32>;
fn vtex_word(vt: u32, index: u32) -> u32 { return vtex_words[vt + index]; }
fn vtex_word2(vt: u32, index: u32) -> vec2u {
    return vec2u(vtex_words[vt + index], vtex_words[vt + index + 1u]);
}
@compute @workgroup_size(1) fn main() {
    results[0] = vtex_curve_distance(0u, 0u, vec2f(1.0), 2.0);
    results[1] = select(0.0, 1.0, vtex_curve_inside(0u, 0u, vec2f(1.0)));
}
";

fn curve_text() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/wgsl/vtex/curve.wgsl");
    std::fs::read_to_string(path).expect("the module is there")
}

#[test]
fn curve_module_is_valid() {
    let text = format!("{PRELUDE}{}", curve_text());
    let module = naga::front::wgsl::parse_str(&text)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .expect("valid with core WebGPU alone");
}

#[test]
fn masks_are_those_of_the_format() {
    let text = curve_text();
    for (name, value) in [
        ("VTEX_CURVE_COUNT_MASK", MAX_CURVE_SEGMENTS),
        ("VTEX_CURVE_STEP_MASK", MAX_CURVE_STEPS),
    ] {
        let line = format!("const {name}: u32 = {value:#x}u;");
        assert!(text.contains(&line), "{line}");
    }
}
