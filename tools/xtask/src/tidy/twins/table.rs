//! Functions whose twin has another name, or that have none.

/// File of `cpu/`, its function, and the function of WGSL that it is the twin of.
pub(super) const OTHERWISE: &[(&str, &str, &str)] = &[
    ("edge.rs", "is_branch", "vtex_groups_is_branch"),
    ("edge.rs", "within", "vtex_msdf_covered"),
    ("rows.rs", "new", "vtex_rows_phase"),
    ("rows.rs", "new", "vtex_samples_of_rows"),
    ("sample.rs", "sample", "vtex_sample_at"),
    ("settings.rs", "read", "vtex_texture"),
    ("walk.rs", "new", "vtex_composite_start"),
    ("walk.rs", "of", "vtex_resolved"),
    ("words.rs", "word_float4", "vtex_word_float2"),
    ("words.rs", "words", "vtex_word2"),
    ("words.rs", "words", "vtex_word4"),
];

/// File of `cpu/`, its functions, and why WGSL has none.
pub(super) const ONLY_RUST: &[(&str, &[&str], &str)] = &[
    (
        "cell.rs",
        &["ends", "ends_of", "per_cell"],
        "for the colour of a part of the canvas, which only the baker asks for",
    ),
    (
        "color.rs",
        &["apply_straight", "decode_channel", "encode_channel"],
        "WGSL has vectors and select",
    ),
    (
        "edge.rs",
        &["taken", "target"],
        "WGSL has them in each walk: its walks share no loop over a mutable place",
    ),
    ("gradient.rs", &["is_zero"], "named for readers"),
    (
        "image.rs",
        &["bilinear", "sample"],
        "the body of a loop of vtex_image_filtered, and what the sampler does",
    ),
    ("picture.rs", &["average", "point"], "parts of vtex_picture"),
    ("picture.rs", &["places"], "for tests and reports"),
    ("plane.rs", &["sub"], "WGSL has vectors"),
    ("rows.rs", &["mean"], "a part of vtex_samples_uv"),
    (
        "sample.rs",
        &["lookup", "placed"],
        "a part of vtex_sample_at that tests use too",
    ),
    (
        "samples.rs",
        &["base"],
        "one expression of vtex_samples_filled",
    ),
    ("segment.rs", &["is_constant"], "for fine cells"),
    (
        "walk.rs",
        &["end", "hide", "part", "take", "value"],
        "the variants of vtex_composite_draw have what they need of each",
    ),
    (
        "words.rs",
        &["is_past", "word_of"],
        "an index past the end is no error in WGSL",
    ),
];

/// Function of WGSL, and why the twin has none.
pub(super) const ONLY_WGSL: &[(&str, &str)] = &[
    ("vtex_cell_is_block", "layout.rs has it, for packing too"),
    ("vtex_resolved_count", "one expression of Resolved::of"),
    (
        "vtex_outline_tag",
        "settings.rs reads it once for all lookups",
    ),
    (
        "vtex_paint_linear_words",
        "the twin takes the first two of all words",
    ),
    ("vtex_rows_count", "one expression of Rows::mean"),
    ("vtex_rows_marks", "the twin has truths instead"),
    ("vtex_samples_in_cell", "picture.rs makes the struct"),
];
