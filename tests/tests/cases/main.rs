//! One-issue cases: small drawings, each of which tests one feature of SVG, baked with the default
//! options and compared with a supersampled truth, on the twin and on the GPU.
//!
//! A chapter is a folder of `tests/data/svg` with a table `cases.tsv`, which has a line for every
//! drawing beside it (`table.rs` says what its columns mean). `VTEX_FILTER` takes only the cases
//! whose `chapter/name` contains it, `VTEX_PICTURES=1` writes pictures of all of them and not only
//! of those that fail, `VTEX_REPORT` is a folder for all figures, and `VTEX_MARKS=write` puts what
//! fails now into the tables as known failures, which is to be read before it is kept.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod chapter;
mod look;
mod table;
mod verdict;

use std::path::{Path, PathBuf};

/// Where chapters lie.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/svg")
}

macro_rules! chapters {
    ($($test:ident $folder:literal)*) => {
        $(
            #[test]
            fn $test() {
                chapter::run($folder);
            }
        )*

        /// No chapter is left out.
        #[test]
        fn every_chapter_is_run() {
            let mut found: Vec<String> = std::fs::read_dir(root())
                .unwrap()
                .map(|entry| entry.unwrap())
                .filter(|entry| entry.path().join(table::FILE).is_file())
                .map(|entry| entry.file_name().into_string().unwrap())
                .collect();
            found.sort();
            let mut run = vec![$($folder),*];
            run.sort_unstable();
            assert_eq!(found, run);
        }
    };
}

chapters! {
    blend "blend"
    clip_path "clip-path"
    css "css"
    fill_rule "fill-rule"
    filter "filter"
    gradient_linear "gradient-linear"
    gradient_radial "gradient-radial"
    group_opacity "group-opacity"
    image "image"
    marker "marker"
    mask "mask"
    nested_svg "nested-svg"
    paint_solid "paint-solid"
    pattern "pattern"
    stroke "stroke"
    switch "switch"
    text "text"
    transform "transform"
    use_symbol "use-symbol"
    viewbox "viewbox"
    visibility "visibility"
}
