//! Styles as browsers read them: each drawing of `tests/data/style` looks like the one beside it
//! that says the same in plain attributes, written by hand (`tests/data/style/README.md`).

#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tiny_skia::{Color, Pixmap, Transform};
use vtex_tests::fonts;

/// A pixel is as it should be when no channel is further off, in steps of 255: colours are rounded
/// on both ways.
const CLOSE: u8 = 3;
/// Pixels of 40,000 that may be further off: edges of clips, which resvg smooths differently.
const FEW: usize = 100;

#[test]
fn drawings_look_like_their_plain_ones() {
    let mut wrong = Vec::new();
    for name in names() {
        let styled = std::fs::read(folder().join(format!("{name}.svg"))).unwrap();
        let plain = std::fs::read(folder().join(format!("{name}.plain.svg"))).unwrap();
        let text = vtex_baker::styled_text(&styled, &fonts::library()).unwrap();
        if text.as_bytes() == styled {
            wrong.push(format!("{name}: the stage has nothing to do"));
        }
        let same = vtex_baker::styled_text(&plain, &fonts::library()).unwrap();
        if same.as_bytes() != plain {
            wrong.push(format!("{name}: the plain drawing is not plain"));
        }
        let (found, wanted) = (picture(&text), picture(&same));
        let pairs = found.data().chunks(4).zip(wanted.data().chunks(4));
        let is_off =
            |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > CLOSE);
        let off = pairs.filter(is_off).count();
        if off > FEW {
            let paths = [("styled", &found), ("plain", &wanted)].map(|(kind, picture)| {
                let path =
                    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.{kind}.png"));
                picture.save_png(&path).unwrap();
                path.display().to_string()
            });
            wrong.push(format!("{name}: {off} pixels are off: {}", paths.join(" ")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/style")
}

/// Names of all drawings; each has both files.
fn names() -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let files = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names = files.filter_map(|file| {
        let name = file.strip_suffix(".svg")?;
        Some(name.strip_suffix(".plain").unwrap_or(name).to_owned())
    });
    let names: BTreeSet<String> = names.collect();
    assert!(names.len() > 40, "{names:?}");
    names
}

/// What resvg shows on white.
fn picture(svg: &str) -> Pixmap {
    let options = usvg::Options {
        fontdb: fonts::library(),
        font_size: 16.0,
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).unwrap();
    let mut pixmap = Pixmap::new(200, 200).unwrap();
    pixmap.fill(Color::WHITE);
    let scale = Transform::from_scale(200.0 / tree.size().width(), 200.0 / tree.size().height());
    resvg::render(&tree, scale, &mut pixmap.as_mut());
    pixmap
}
