//! Names of files: what a command reads is not written to, and no name needs to be UTF-8.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";

fn vtex(folder: &Path, arguments: &[&OsStr]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_vtex"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("the command starts")
}

fn succeeds(folder: &Path, arguments: &[&OsStr]) -> String {
    let output = vtex(folder, arguments);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {text}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn no_command_overwrites_what_it_reads() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    fs::write(folder.join("square.svg"), SQUARE).expect("a file can be written");
    succeeds(
        folder,
        &["bake", "square.svg", "-o", "square.vtex"].map(OsStr::new),
    );
    let read = |name: &str| fs::read(folder.join(name)).expect("the file is there");
    let before = ["square.svg", "square.vtex"].map(read);
    for (line, words) in [
        ("bake square.svg -o square.svg", "would be overwritten"),
        (
            "bake square.svg -o x.vtex --depfile square.svg",
            "would be overwritten",
        ),
        (
            "preview square.vtex -o square.vtex --size 8",
            "would be overwritten",
        ),
        ("bake square.svg -o x.vtex --depfile x.vtex", "--depfile"),
    ] {
        let arguments: Vec<&OsStr> = line.split(' ').map(OsStr::new).collect();
        let output = vtex(folder, &arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{line}: {text}");
        assert!(text.contains(words), "{line}: {text}");
        assert!(!folder.join("x.vtex").exists(), "{line} leaves a file");
    }
    assert_eq!(
        ["square.svg", "square.vtex"].map(read),
        before,
        "both are as they were"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn names_need_not_be_utf8() {
    use std::os::unix::ffi::OsStringExt as _;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let folder = folder.path();
    let name = |extension: &str| OsString::from_vec([b"b\xffd.", extension.as_bytes()].concat());
    let [svg, file] = ["svg", "vtex"].map(name);
    fs::write(folder.join(&svg), SQUARE).expect("a file can be written");
    let [bake, validate, format, json, output] =
        ["bake", "validate", "--format", "json", "-o"].map(OsStr::new);
    succeeds(folder, &[bake, format, json, &svg, output, &file]);
    let text = succeeds(folder, &[validate, format, json, &file]);
    assert!(text.contains("b\u{fffd}d.vtex"), "{text}");
}
