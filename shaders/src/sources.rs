//! The WGSL files, by module name.

macro_rules! sources {
    ($($name:literal,)*) => {
        /// Every module of `wgsl/` with its text, by name. One line a file.
        pub(crate) const SOURCES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../wgsl/", $name, ".wgsl"))),)*];
    };
}

sources! {
    "core/color",
    "core/layout",
    "core/math",
    "core/query",
    "root/batch",
    "root/fragment",
    "vtex/address_any",
    "vtex/address_clamp",
    "vtex/cell",
    "vtex/cells_list",
    "vtex/cells_solid",
    "vtex/composite_front",
    "vtex/composite_translucent",
    "vtex/coverage_full",
    "vtex/coverage_msdf",
    "vtex/coverage_outline",
    "vtex/encoded_image",
    "vtex/encoded_solid",
    "vtex/entry_shape",
    "vtex/entry_outline",
    "vtex/footprint",
    "vtex/image",
    "vtex/matrix_affine",
    "vtex/matrix_identity",
    "vtex/minify_mips",
    "vtex/minify_none",
    "vtex/msdf",
    "vtex/over_shape",
    "vtex/over_outline",
    "vtex/over_paint",
    "vtex/paint_alpha",
    "vtex/paint_color",
    "vtex/sample",
    "vtex/settings_header",
    "vtex/settings_key",
    "vtex/source_image",
    "vtex/source_solid",
    "vtex/texel_alpha",
    "vtex/texel_color",
    "vtex/value_any",
    "vtex/value_color",
    "vtex/value_mask",
    "vtex/words",
}
