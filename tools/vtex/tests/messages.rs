//! What a user is told, as data: `messages.tsv` has a command line in each row, its exit code, and
//! words that it must print.
//!
//! All rows run in one folder with the files that [`full_folder`] makes. A row that fails writes
//! nothing, and says why in one line that starts with `vtex: `, unless clap says it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";
const ROWS: &str = include_str!("messages.tsv");

fn vtex(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vtex"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .expect("the command starts")
}

fn succeeds(folder: &Path, line: &str) -> Output {
    let output = vtex(folder, line);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{line}: {text}");
    output
}

fn json(folder: &Path, line: &str) -> Value {
    let output = succeeds(folder, &format!("{line} --format json"));
    serde_json::from_slice(&output.stdout).expect("stdout is JSON")
}

fn put(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("a file can be written");
}

/// A folder with a baked drawing.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    put(folder.path(), "square.svg", SQUARE);
    put(
        folder.path(),
        "other.svg",
        &SQUARE.replace("d03020", "d03021"),
    );
    succeeds(folder.path(), "bake square.svg -o square.vtex");
    folder
}

/// As [`folder`], with the other files that the rows name.
fn full_folder() -> TempDir {
    let folder = folder();
    let inside = folder.path();
    put(inside, "not-baked.vtex", SQUARE);
    put(inside, "slow.svg", &slow());
    let hdr = |size: &str| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n");
    put(inside, "huge.hdr", &hdr("-Y 4000000 +X 4000000"));
    put(inside, "cut.hdr", &hdr("-Y 4 +X 8"));
    fs::create_dir(inside.join("parts")).expect("a folder");
    let texture = fs::read(inside.join("square.vtex")).expect("it was baked");
    fs::write(inside.join("parts/shader.wgsl"), &texture).expect("a file can be written");
    put(inside, "parts/svg.png", SQUARE);
    put(inside, "parts/index.html", SQUARE);
    for name in ["folder.png", "in"] {
        fs::create_dir(inside.join(name)).expect("a folder");
    }
    put(inside, "in/in.svg", SQUARE);
    for (name, count) in [("blur", 1), ("blurs", 4)] {
        let shapes = blurred(count);
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><filter id='blur'>\
             <feGaussianBlur stdDeviation='1'/></filter>{shapes}</svg>"
        );
        put(inside, &format!("{name}.svg"), &svg);
        succeeds(inside, &format!("bake {name}.svg -o {name}.vtex --size 64"));
    }
    folder
}

/// Blurred shapes, each an element of its own with a warning of its own.
fn blurred(count: usize) -> String {
    let shape =
        |index| format!("<path id='blurred{index}' d='M{index}0 5h9v9h-9z' filter='url(#blur)'/>");
    (0..count).map(shape).collect()
}

/// One path of many segments that all cross each other: minutes of work.
fn slow() -> String {
    let points: String = (0..60_000_u64)
        .map(|index| format!("L{} {}", index * 7919 % 1021, index * 104_729 % 1013))
        .collect();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1024 1024'>\
         <path fill-rule='evenodd' d='M0 0{points}z'/></svg>"
    )
}

/// All files and folders below a folder.
fn names(folder: &Path) -> BTreeSet<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder can be listed");
    let paths = entries.map(|entry| entry.expect("an entry can be read").path());
    paths.collect()
}

#[test]
fn every_row_holds() {
    let folder = full_folder();
    let folder = folder.path();
    let mut count = 0;
    for row in ROWS.lines().skip(1) {
        let [wanted, line, words] = row.split('\t').collect::<Vec<_>>()[..] else {
            panic!("not three columns: {row}");
        };
        let before = names(folder);
        let output = vtex(folder, line);
        let text = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code().map(|code| code.to_string());
        assert_eq!(code.as_deref(), Some(wanted), "{line}: {text}");
        // What a command prints on stdout, `info` for one, is looked at too; lines may be broken
        // anywhere.
        let all = format!("{text} {}", String::from_utf8_lossy(&output.stdout));
        let all = all.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(all.contains(words), "{line}: no \"{words}\" in: {all}");
        if wanted != "0" {
            assert_eq!(names(folder), before, "{line}: files changed");
            let by_clap = text.starts_with("error: ");
            let one_line = text.starts_with("vtex: ") && text.lines().count() == 1;
            assert!(by_clap || one_line, "{line}: {text}");
        }
        count += 1;
    }
    assert!(count > 30, "{count} rows");
}

#[test]
fn pictures_are_reported_as_json() {
    let folder = folder();
    let folder = folder.path();
    let preview = "preview square.vtex -o p.png --size 16x8 --filter footprint --spp 1";
    let report = json(folder, preview);
    let bytes = fs::metadata(folder.join("p.png")).expect("a picture").len();
    assert_eq!(report["output"], "p.png", "{report}");
    assert_eq!(report["bytes"], bytes, "{report}");
    assert_eq!(report["size_px"], serde_json::json!([16, 8]), "{report}");
    assert_eq!(report["filter"], "footprint", "{report}");
    assert_eq!(report["spp"], 1, "{report}");
    assert!(report["seconds"].as_f64() > Some(0.0), "{report}");
}

#[test]
fn compare_knows_the_source() {
    let folder = folder();
    let compare = |svg: &str| {
        json(
            folder.path(),
            &format!("compare {svg} square.vtex --size 8 --zoom 1"),
        )
    };
    assert_eq!(compare("square.svg")["source_matches"], true);
    assert_eq!(compare("other.svg")["source_matches"], false);
}

#[test]
fn extract_counts_files_before_it_writes_them() {
    let folder = folder();
    let folder = folder.path();
    let written = json(folder, "extract square.vtex -o all");
    let count = written.as_array().expect("a list").len();
    assert_eq!(names(&folder.join("all")).len(), count);
    succeeds(
        folder,
        &format!("extract square.vtex -o again --max-files {count}"),
    );
    let most = count - 1;
    let output = vtex(
        folder,
        &format!("extract square.vtex -o none --max-files {most}"),
    );
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains(&format!("--max-files {count}")), "{text}");
    assert!(!folder.join("none").exists(), "a folder was made");
}

#[test]
fn render_takes_a_filter_and_names_a_size_too_large() {
    if !vtex_testing::gpu("the filters of vtex render") {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    // Hairlines thinner than a pixel, which footprints cover in part, and points hit or miss.
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
        <path d='M0 0H8V8H0z' fill='#fff'/><path d='M0 3.2H8V3.3H0zM0 3.7H8V3.8H0z'/></svg>";
    fs::write(folder.join("lines.svg"), svg).expect("a file can be written");
    // A small mip 0, so that the cells answer and not the mips; MSDFs, since paper mode smooths
    // no others.
    let wide = "--size 16 --mode msdf --smoothing 0.5";
    succeeds(folder, &format!("bake lines.svg -o lines.vtex {wide}"));
    let picture = |name: &str, options: &str| {
        let line = format!("render lines.vtex -o {name}.png --size 64 --spp 1 {options}");
        let report = json(folder, &line);
        assert_eq!(report["size_px"], serde_json::json!([64, 64]), "{report}");
        let filter = options.rsplit(' ').next().filter(|word| !word.is_empty());
        assert_eq!(report["filter"], filter.unwrap_or("point"), "{report}");
        fs::read(folder.join(format!("{name}.png"))).expect("a picture")
    };
    let default = picture("default", "");
    let [point, footprint, paper] =
        ["point", "footprint", "paper"].map(|name| picture(name, &format!("--filter {name}")));
    assert!(default == point, "the default is not the point filter");
    assert!(default != footprint, "the footprint filter changes nothing");
    assert!(default != paper, "paper mode changes nothing");
    assert!(footprint != paper, "paper mode is the footprint filter");
    let output = vtex(
        folder,
        "render lines.vtex -o large.png --size 16384 --spp 1",
    );
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains("vtex: --size: 16384 x 16384"), "{text}");
}
