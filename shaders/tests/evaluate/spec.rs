//! Keys from contents, and text from keys.

use vtex_format::{AddressMode, DistanceOutline, Features, SamplerSettings, SpecKey};
use vtex_shaders::{BindingSlot, FilterMode, PackOptions, fragment, kernel_key, spec_key};

use crate::builder::{Cover, key, paint, row_of, set_canvas, set_list, set_solid};

#[test]
fn keys_say_what_a_file_holds() {
    let mut file = row_of(3);
    assert_eq!(SpecKey::for_file(&file).features, 0);
    set_solid(&mut file, 0, [1.0, 1.0, 1.0, 0.5]);
    assert_eq!(
        SpecKey::for_file(&file).features,
        0,
        "a translucent cell is one colour all the same"
    );
    set_list(
        &mut file,
        1,
        &[(Cover::Edge(1.0), [1.0; 4]), (Cover::Full, [1.0; 4])],
    );
    assert_eq!(
        SpecKey::for_file(&file).features,
        Features::LISTS | Features::MSDF
    );
    let glass = [1.0, 1.0, 1.0, 0.5];
    let outline = DistanceOutline {
        width_texels: 0.5,
        paint: paint(&mut file, glass),
    };
    let mut outlined = file.clone();
    outlined.meta.sampler.outline = Some(outline);
    let expected = Features::LISTS | Features::MSDF | Features::OUTLINE | Features::TRANSLUCENT;
    assert_eq!(SpecKey::for_file(&outlined).features, expected);
    set_list(
        &mut file,
        2,
        &[
            (Cover::Full, glass),
            (Cover::Full, glass),
            (Cover::Full, glass),
        ],
    );
    assert_ne!(SpecKey::for_file(&file).features & Features::TRANSLUCENT, 0);
    set_canvas(&mut file, [2, 2], |_, _, _| [0; 4]);
    assert_ne!(SpecKey::for_file(&file).features & Features::MIPS, 0);
}

#[test]
fn overrides_change_the_key() {
    let file = row_of(1);
    let options = PackOptions {
        address: Some([AddressMode::Mirror, AddressMode::Border]),
        texture_matrix: Some([2.0, 0.0, 0.0, 2.0, 0.0, 0.0]),
        ..PackOptions::default()
    };
    assert_eq!(spec_key(&file, &options).features, Features::MAPPING);
    let repeated = PackOptions {
        address: Some([AddressMode::Clamp, AddressMode::Repeat]),
        ..PackOptions::default()
    };
    assert_eq!(spec_key(&file, &repeated).features, Features::MAPPING);
    let stored = SpecKey::for_file(&file);
    assert_eq!(spec_key(&file, &PackOptions::default()), stored);
    let filtered = PackOptions {
        filter: FilterMode::Footprint,
        texture_matrix: Some(SamplerSettings::default().texture_matrix),
        ..PackOptions::default()
    };
    let mut moved = file.clone();
    moved.meta.sampler.texture_matrix[4] = 0.5;
    assert_eq!(SpecKey::for_file(&moved).features, Features::MAPPING);
    let back = spec_key(&moved, &filtered).features;
    assert_eq!(back, Features::FOOTPRINT, "overridden again");
}

#[test]
fn code_of_absent_features_is_not_in_the_text() {
    for features in 0..=Features::ALL {
        // Others have the text of one of these.
        if kernel_key(&key(features)) != key(features) {
            continue;
        }
        let text = fragment(&key(features), BindingSlot::default());
        let has = |feature: u32| features & feature != 0;
        let lists = has(Features::LISTS);
        let msdf = has(Features::MSDF);
        let groups = has(Features::GROUPS);
        let curves = has(Features::CURVES);
        let images = has(Features::IMAGES);
        let translucent = has(Features::TRANSLUCENT);
        let gradients = has(Features::GRADIENTS);
        let rows = has(Features::FOOTPRINT);
        let outline = has(Features::OUTLINE);
        let paper = has(Features::PAPER);
        // Opaque solid paints alone are stored as they are composited.
        let brushes = translucent || groups || paper;
        for (symbol, wanted) in [
            ("fn vtex_walk(", lists),
            ("fn vtex_mapping_linear(", has(Features::MAPPING)),
            ("fn vtex_composite_draw(", lists),
            ("struct VtexBrushColor {", brushes),
            ("return vtex_samples_wind(", curves),
            ("vtex_msdf_", msdf),
            ("vtex_rows_", rows),
            ("vtex_image_entry", images),
            ("vtex_outline_", outline || paper),
            ("vtex_paper", paper),
            ("vtex_color_", brushes || gradients),
            ("vtex_gradient", gradients),
            ("vtex_groups", groups),
            ("vtex_blend", groups),
        ] {
            assert_eq!(
                text.contains(symbol),
                wanted,
                "{symbol} with features {features:#b}"
            );
        }
    }
}

#[test]
fn every_name_can_live_in_another_shader() {
    let text = fragment(
        &key(Features::ALL & !Features::MASK),
        BindingSlot::default(),
    );
    for line in text.lines() {
        for start in ["fn ", "const ", "struct ", "alias "] {
            if let Some(name) = line.strip_prefix(start) {
                assert!(name.to_lowercase().starts_with("vtex"), "{line}");
            }
        }
    }
}
