//! Keys from contents, and text from keys.

use vtex_format::{AddressMode, DistanceOutline, Features, SamplerSettings, SpecKey};
use vtex_shaders::{BindingSlot, FilterMode, PackOptions, fragment, spec_key};

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
    assert_eq!(SpecKey::for_file(&file).max_entries, 2);
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
    assert_eq!(SpecKey::for_file(&file).max_entries, 3);
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
    let key = spec_key(&file, &options);
    let modes = [key.address_u, key.address_v];
    assert_eq!(modes, [AddressMode::Mirror, AddressMode::Border]);
    assert_eq!(key.features, Features::TEXTURE_MATRIX);
    let stored = SpecKey::for_file(&file);
    assert_eq!(spec_key(&file, &PackOptions::default()), stored);
    let filtered = PackOptions {
        filter: FilterMode::Footprint,
        texture_matrix: Some(SamplerSettings::default().texture_matrix),
        ..PackOptions::default()
    };
    let mut moved = file.clone();
    moved.meta.sampler.texture_matrix[4] = 0.5;
    assert_eq!(SpecKey::for_file(&moved).features, Features::TEXTURE_MATRIX);
    let back = SpecKey {
        features: Features::RAMPS,
        ..stored
    };
    assert_eq!(spec_key(&moved, &filtered), back, "overridden again");
}

#[test]
fn code_of_absent_features_is_not_in_the_text() {
    for features in 0..=Features::ALL {
        let text = fragment(&key(features), BindingSlot::default());
        let has = |feature: u32| features & feature != 0;
        let lists = has(Features::LISTS);
        let msdf = lists && has(Features::MSDF);
        let clips = lists && has(Features::CLIPS);
        let blends = lists && has(Features::BLENDS);
        let groups = lists && has(Features::GROUPS) || blends;
        // Tests are curves.
        let curves = lists && has(Features::CURVES) || clips;
        let images = lists && has(Features::IMAGES);
        // An image's texels may be translucent.
        let translucent = lists && (has(Features::TRANSLUCENT) || images);
        let gradients = has(Features::GRADIENTS);
        let edges = msdf || curves;
        // [SFG22] eq. 2 draws by distance whatever the filter.
        let ramps = edges && (has(Features::RAMPS) || has(Features::OUTLINE));
        let outline = edges && has(Features::OUTLINE);
        let scopes = groups || clips && ramps;
        // With groups a mask is looked up in colour.
        let mask = has(Features::MASK) && !scopes;
        let one_walk = !outline && (!translucent || mask) && msdf != curves;
        for (symbol, wanted) in [
            ("vtex_composite", ramps && !one_walk),
            ("vtex_hit", lists && !ramps),
            ("vtex_inside", lists && !ramps),
            ("vtex_msdf_", msdf),
            ("vtex_math_median", msdf),
            ("vtex_curve_", curves),
            ("vtex_segment_winding", curves),
            ("vtex_segment_distance", curves && ramps),
            ("fn vtex_edge(", ramps && (!one_walk || scopes)),
            ("vtex_reach_", ramps && one_walk),
            ("vtex_ramp_", ramps),
            ("vtex_image_", images || has(Features::MIPS)),
            ("fn vtex_image_entry(", images),
            ("vtex_texel", images || has(Features::MIPS)),
            ("_outline", edges && has(Features::OUTLINE)),
            ("vtex_over", ramps && (translucent && !mask || scopes)),
            (
                "vtex_color_encode",
                (translucent && !mask || scopes) && (ramps || images),
            ),
            (
                "vtex_color_decode",
                !mask && (translucent || gradients) || scopes,
            ),
            ("vtex_gradient", gradients),
            (
                "vtex_tint",
                !ramps && (scopes || gradients && translucent && !mask),
            ),
            ("vtex_matrix_linear", has(Features::TEXTURE_MATRIX)),
            ("alias VtexValue = f32;", mask),
            ("vtex_clips", clips && !ramps),
            ("vtex_scopes", scopes),
            ("vtex_frames", scopes),
            ("vtex_flow_wait", clips && ramps),
            ("vtex_group_", groups),
            ("vtex_tone_", groups),
            ("vtex_blend(", groups),
            ("vtex_blend_", blends),
            ("vtex_address_axis", false),
        ] {
            assert_eq!(
                text.contains(symbol),
                wanted,
                "{symbol} with features {features:#b}"
            );
        }
    }
    let mut repeats = key(0);
    repeats.address_v = AddressMode::Repeat;
    assert!(fragment(&repeats, BindingSlot::default()).contains("vtex_address_axis"));
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
