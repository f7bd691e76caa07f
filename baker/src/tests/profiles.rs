//! Files for fast loading load as what they are made from.

use std::path::Path;

use vtex_format::VtexFile;
use vtex_shaders::{FilterMode, PackOptions, check_fine, pack};
use vtex_testing::{Corpus, corpus, slow_only};

use crate::{BakeConfig, Profile, Resources, bake};

/// Packs a file and the same without lists, which shows that nothing is cut.
fn check(svg: &[u8], name: &str) {
    let bake = |profile| {
        let config = BakeConfig {
            profile,
            ..BakeConfig::default()
        };
        bake(svg, &config, &Resources::default()).unwrap()
    };
    let small = bake(Profile::Size);
    assert!(small.fine.is_empty());
    for (profile, filter) in [
        (Profile::Load, FilterMode::Point),
        (Profile::LoadFootprints, FilterMode::Footprint),
    ] {
        let quick = bake(profile);
        assert_eq!(quick.check(), [], "{name}");
        assert_eq!(check_fine(&quick), None, "{name}");
        let options = PackOptions {
            filter,
            ..PackOptions::default()
        };
        let expected = pack(&small, &options);
        let alone = VtexFile {
            cells: Vec::new(),
            entries: Vec::new(),
            curves: Vec::new(),
            outlines: None,
            ..quick.clone()
        };
        assert!(pack(&quick, &options) == expected, "{name}, {filter:?}");
        assert!(pack(&alone, &options) == expected, "{name}, {filter:?}");
    }
}

#[test]
fn samples_load_as_what_they_are_made_from() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/svg");
    for folder in ["paper", "image"] {
        for path in corpus::svg_files(&data.join(folder)) {
            check(&std::fs::read(&path).unwrap(), &path.to_string_lossy());
        }
    }
}

#[test]
fn real_files_load_as_what_they_are_made_from() {
    let untested = "real files of the profiles for loading";
    let slow = slow_only(untested);
    let Some(corpus) = slow.then(|| Corpus::find(untested)).flatten() else {
        return;
    };
    for path in corpus.svg_files(&["paper5", "icons", "flags", "hard"]) {
        check(&std::fs::read(&path).unwrap(), &corpus.name(&path));
    }
}
