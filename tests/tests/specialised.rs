//! A file's shader holds the code that its drawing needs and no other.

use std::collections::BTreeSet;
use std::path::Path;

use vtex_baker::{BakeConfig, Mode, Resources, bake};

/// What can be absent, and a function that only it has.
const CODE: [(&str, &str); 7] = [
    ("curves", "fn vtex_segment_winding("),
    ("msdf", "fn vtex_msdf_distance("),
    ("gradients", "fn vtex_gradient("),
    ("clips", "fn vtex_clips("),
    ("stack", "fn vtex_frames_pop("),
    ("blends", "fn vtex_blend_separable("),
    ("patches", "fn vtex_image_entry("),
];

/// One drawing of each kind, and the code it needs.
const FILES: [(&str, Mode, &[&str]); 9] = [
    ("paint-solid/color-forms", Mode::Auto, &["curves"]),
    ("paint-solid/color-forms", Mode::Msdf, &["msdf"]),
    ("paint-solid/color-forms", Mode::Raster, &["patches"]),
    (
        "gradient-linear/equal-offsets",
        Mode::Auto,
        &["curves", "gradients"],
    ),
    ("clip-path/circle", Mode::Auto, &["curves", "clips"]),
    ("group-opacity/overlap", Mode::Auto, &["curves", "stack"]),
    ("mask/alpha", Mode::Auto, &["curves", "stack"]),
    (
        "blend/element-multiply",
        Mode::Auto,
        &["curves", "stack", "blends"],
    ),
    ("filter/blur", Mode::Auto, &["patches"]),
];

#[test]
fn files_of_each_kind_hold_their_own_code_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg");
    for (name, mode, wanted) in FILES {
        let svg = std::fs::read(folder.join(format!("{name}.svg"))).unwrap();
        let config = BakeConfig {
            mode,
            ..BakeConfig::default()
        };
        let file = bake(&svg, &config, &Resources::default()).unwrap();
        let text = &file.shader.wgsl_fragment;
        let found: BTreeSet<&str> = CODE
            .iter()
            .filter(|(_, function)| text.contains(function))
            .map(|&(code, _)| code)
            .collect();
        let wanted: BTreeSet<&str> = wanted.iter().copied().collect();
        assert_eq!(found, wanted, "{name}, {mode:?}");
    }
}
