//! A file's shader holds the code that its drawing needs and no other.

use std::collections::BTreeSet;
use std::path::Path;

use vtex_baker::{BakeConfig, Mode, Resources, bake};

/// What can be absent, and a piece of text that only it has. Clips and blend modes are no code of
/// their own: a test is one branch of the walk, which a constant of the key switches off, and blend
/// modes come with groups.
const CODE: [(&str, &str); 5] = [
    // The functions of segments are there for MSDFs too, where nothing calls them.
    ("curves", "vtex_samples_filled(winding, command.w)"),
    ("msdf", "fn vtex_msdf_distance("),
    ("gradients", "fn vtex_gradient("),
    ("groups", "fn vtex_groups("),
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
    ("clip-path/circle", Mode::Auto, &["curves"]),
    ("group-opacity/overlap", Mode::Auto, &["curves", "groups"]),
    ("mask/alpha", Mode::Auto, &["curves", "groups"]),
    ("blend/element-multiply", Mode::Auto, &["curves", "groups"]),
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
            .filter(|(_, piece)| text.contains(piece))
            .map(|&(code, _)| code)
            .collect();
        let wanted: BTreeSet<&str> = wanted.iter().copied().collect();
        assert_eq!(found, wanted, "{name}, {mode:?}");
    }
}
