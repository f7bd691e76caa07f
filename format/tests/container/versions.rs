//! Kept files of each major version, which later readers must still take for what they are.
//!
//! `tests/versions` holds a bake of version 1, without its shader, and files of version 2 with what
//! their reader found in them. They are written once and stay (CONTRIBUTING.md says until when they
//! may change).

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use vtex_format::{Codec, Limits, ReadError, VtexFile, directory, validate};

use crate::grouped::grouped;
use crate::sample;

fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/versions")
        .join(name)
}

#[test]
fn version_1_is_to_be_baked_again() {
    let bytes = std::fs::read(kept("1.vtex")).unwrap();
    let limits = Limits::default();
    let error = VtexFile::parse(&bytes, &limits).unwrap_err();
    assert!(matches!(error, ReadError::Outdated { .. }), "{error:?}");
    assert_eq!(error, directory(&bytes, &limits).unwrap_err());
    assert_eq!(validate(&bytes, &limits), [error.issue().clone()]);
    assert_eq!(
        error.to_string(),
        "outdated .vtex file: V1008 HEAD @0x8: version 1.0; bake it again: `vtex bake drawing.svg \
         -o drawing.vtex`"
    );
}

/// What a reader finds in a file, one line for each bundle, section and field.
fn summary(bytes: &[u8]) -> String {
    let limits = Limits::default();
    let directory = directory(bytes, &limits).unwrap();
    let (major, minor) = (directory.version_major, directory.version_minor);
    let mut text = format!("version {major}.{minor}, {} bytes\n", bytes.len());
    for bundle in &directory.bundles {
        let (stored, raw) = (bundle.stored_bytes, bundle.raw_bytes);
        let codec = match bundle.codec {
            Codec::Raw => "raw",
            Codec::Zstd => "zstd",
            Codec::Dictionary => "dictionary",
            Codec::Unknown(_) => "unknown",
        };
        writeln!(text, "bundle {codec}, {stored} bytes of {raw}").unwrap();
        for section in directory.bundle_sections(bundle) {
            let (tag, raw) = (section.tag, section.raw_bytes);
            writeln!(text, "  {tag} {raw} at {}", section.start_bytes).unwrap();
        }
    }
    let file = VtexFile::parse(bytes, &limits).unwrap();
    // Field by field, so that a field too many does not compile.
    let VtexFile {
        meta,
        spec,
        shader,
        paints,
        gradients,
        shapes,
        layers,
        cells,
        entries,
        curves,
        outlines,
        fine,
        tiles,
        images,
        provenance,
    } = &file;
    // Its text is long, and repeats one line.
    let text_hash = blake3::hash(shader.wgsl_fragment.as_bytes());
    let text_bytes = shader.wgsl_fragment.len();
    let shader = (
        shader.abi,
        text_bytes,
        text_hash.to_hex(),
        &shader.batch_spirv,
    );
    let fields: [(&str, &dyn std::fmt::Debug); 14] = [
        ("meta", meta),
        ("spec", spec),
        ("shader", &shader),
        ("paints", paints),
        ("gradients", gradients),
        ("shapes", shapes),
        ("layers", layers),
        ("cells", cells),
        ("entries", entries),
        ("curves", curves),
        ("outlines", outlines),
        ("tiles", tiles),
        ("images", images),
        ("provenance", provenance),
    ];
    for (name, value) in fields {
        writeln!(text, "{name} {value:?}").unwrap();
    }
    // Files that are kept are older than the section.
    if !fine.is_empty() {
        writeln!(text, "fine {fine:?}").unwrap();
    }
    text
}

#[test]
fn version_2_is_read_as_it_was() {
    let mut large = grouped();
    // More than fits one bundle: the shader has one of its own.
    large.shader.wgsl_fragment = "let zero = 0.0;\n".repeat(3_000);
    let samples = [
        ("2-all", sample::small()),
        ("2-outlines", sample::outlined()),
        ("2-bundles", large),
    ];
    let bless = std::env::var("VTEX_BLESS").is_ok_and(|value| value == "1");
    for (name, sample) in samples {
        let (file, text) = (kept(&format!("{name}.vtex")), kept(&format!("{name}.txt")));
        if bless && !file.exists() {
            let bytes = sample.to_bytes().unwrap();
            std::fs::write(&text, summary(&bytes)).unwrap();
            std::fs::write(&file, bytes).unwrap();
        }
        let found = summary(&std::fs::read(&file).unwrap());
        assert!(
            found == std::fs::read_to_string(&text).unwrap(),
            "{name} is read otherwise than it was; now:\n{found}"
        );
    }
}
