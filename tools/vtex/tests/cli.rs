//! The built command: exit codes, messages, what is left on disk.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";

/// A folder of its own for each test, and the command run inside it.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        };
        bench.put("square.svg", SQUARE.as_bytes());
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).expect("a file can be written");
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vtex"));
        command.current_dir(&self.folder).args(arguments);
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments)
            .output()
            .expect("the command starts")
    }

    fn bake_square(&self) -> Vec<u8> {
        let output = self.run(&["bake", "square.svg", "-o", "square.vtex"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        fs::read(self.path("square.vtex")).expect("the bake was written")
    }

    /// Names in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.folder).expect("the folder can be listed");
        let mut names: Vec<String> = entries
            .map(|e| {
                e.expect("an entry can be read")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    }

    /// Runs a command that must fail with `wanted`, one line on stderr that holds `words`, and no
    /// new file.
    fn fails(&self, arguments: &[&str], wanted: i32, words: &str) {
        let before = self.names();
        let output = self.run(arguments);
        let text = stderr(&output);
        assert_eq!(code(&output), wanted, "{arguments:?}: {text}");
        assert_eq!(text.lines().count(), 1, "{arguments:?}: {text}");
        assert!(
            text.starts_with("vtex: ") && text.contains(words),
            "{arguments:?}: {text}"
        );
        assert!(
            output.stdout.is_empty(),
            "{arguments:?}: something on stdout"
        );
        assert_eq!(self.names(), before, "{arguments:?}: files changed");
    }
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("the command ends by itself")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).expect("stdout is JSON")
}

#[test]
fn bad_drawings_are_refused_with_one_line() {
    let bench = Bench::new();
    let zero = "<svg xmlns='http://www.w3.org/2000/svg' width='0' height='0'/>";
    for (name, bytes) in [
        ("text.svg", b"this is not an SVG".as_slice()),
        ("html.svg", b"<html><body/></html>"),
        ("empty.svg", b""),
        ("zero.svg", zero.as_bytes()),
        ("cut.svg", &SQUARE.as_bytes()[..60]),
        (
            "latin1.svg",
            b"<svg xmlns='http://www.w3.org/2000/svg'>\xe4</svg>",
        ),
    ] {
        bench.put(name, bytes);
        bench.fails(&["bake", name, "-o", "out.vtex"], 3, name);
    }
}

#[test]
fn what_cannot_be_read_or_written_is_named() {
    let bench = Bench::new();
    bench.fails(
        &["bake", "none.svg", "-o", "out.vtex"],
        2,
        "none.svg: cannot read",
    );
    bench.fails(&["bake", "*.svgz", "-o", "out"], 2, "*.svgz: no .svg");
    bench.fails(
        &["bake", "square.svg", "-o", "no/such/out.vtex"],
        2,
        "no/such does not exist",
    );
    bench.fails(&["info", "none.vtex"], 2, "none.vtex: cannot read");
    bench.fails(&["validate", "none.vtex"], 2, "none.vtex: cannot read");
    fs::create_dir(bench.path("folder")).expect("a folder can be made");
    bench.fails(&["bake", "folder", "-o", "out"], 2, "folder: no .svg");
    bench.fails(&["info", "folder"], 2, "folder");
    let fonts = [
        "bake",
        "square.svg",
        "-o",
        "x.vtex",
        "--font-dir",
        "nowhere",
    ];
    bench.fails(&fonts, 2, "nowhere");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported() {
    use std::os::unix::fs::FileTypeExt;
    let bench = Bench::new();
    bench.fails(
        &["bake", "square.svg", "-o", "/dev/full"],
        2,
        "/dev/full: cannot write",
    );
    bench.bake_square();
    bench.fails(
        &["preview", "square.vtex", "-o", "/dev/full"],
        2,
        "/dev/full: cannot write",
    );
    let device = fs::metadata("/dev/full").expect("the device is still there");
    assert!(
        device.file_type().is_char_device(),
        "/dev/full was replaced"
    );
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_is_reported() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let path = bench.path("square.svg");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).expect("permissions can be set");
    if fs::read(&path).is_ok() {
        // Nothing is unreadable to root.
        return;
    }
    bench.fails(
        &["bake", "square.svg", "-o", "out.vtex"],
        2,
        "square.svg: cannot read",
    );
}

#[test]
fn damaged_textures_are_refused() {
    let bench = Bench::new();
    let bytes = bench.bake_square();
    bench.put("cut.vtex", &bytes[..bytes.len() / 2]);
    bench.put("empty.vtex", b"");
    bench.put("svg.vtex", SQUARE.as_bytes());
    for name in ["cut.vtex", "empty.vtex", "svg.vtex"] {
        bench.fails(&["info", name], 3, name);
        bench.fails(&["preview", name, "-o", "out.png"], 3, name);
        bench.fails(&["extract", name, "-o", "out"], 3, name);
        bench.fails(&["compare", "square.svg", name], 3, name);
        bench.fails(&["render", name, "-o", "out.png"], 3, name);
        let output = bench.run(&["validate", name]);
        assert_eq!(code(&output), 3, "{}", stderr(&output));
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(&format!("{name}: V1")), "{text}");
    }
}

#[test]
fn usage_errors_are_1() {
    let bench = Bench::new();
    for arguments in [
        &["bake"][..],
        &["bake", "square.svg"],
        &["frobnicate"],
        &["bake", "square.svg", "-o", "x", "--fill-color", "reddish"],
        &["preview", "x.vtex", "-o", "x.png", "--size", "0"],
        &["bake", "square.svg", "-o", "x", "--transform", "1,2"],
    ] {
        let output = bench.run(arguments);
        assert_eq!(code(&output), 1, "{arguments:?}: {}", stderr(&output));
    }
    bench.fails(
        &["bake", "square.svg", "-o", "x.vtex", "--size", "0"],
        1,
        "size",
    );
    bench.fails(
        &["bake", "square.svg", "-o", "-", "--format", "json"],
        1,
        "standard output",
    );
    bench.fails(
        &["bake", "square.svg", "square.svg", "-o", "out"],
        1,
        "two inputs",
    );
    bench.fails(&["render", "square.svg", "-o", "x.jpg"], 1, ".exr");
    for mode in ["curves", "raster"] {
        let outlined = ["bake", "square.svg", "-o", "x", "--outline", "--mode", mode];
        bench.fails(&outlined, 1, "outline needs MSDFs");
    }
    bench.fails(
        &["bake", "square.svg", "-o", "x", "--error", "0"],
        1,
        "error bound",
    );
    let output = bench.run(&["--help"]);
    assert_eq!(code(&output), 0);
}

#[test]
fn one_bad_file_does_not_stop_a_folder() {
    let bench = Bench::new();
    fs::create_dir_all(bench.path("in/deep")).expect("folders can be made");
    bench.put("in/a.svg", SQUARE.as_bytes());
    bench.put("in/b.svg", b"nonsense");
    bench.put("in/deep/c.svg", SQUARE.as_bytes());
    let output = bench.run(&["bake", "in", "-o", "out"]);
    let text = stderr(&output);
    assert_eq!(code(&output), 3, "{text}");
    assert!(
        text.contains("b.svg") && text.contains("2 of 3 baked, 1 failed"),
        "{text}"
    );
    assert!(bench.path("out/a.vtex").exists() && bench.path("out/deep/c.vtex").exists());
    assert!(!bench.path("out/b.vtex").exists());
}

#[test]
fn threads_standard_streams_and_the_cache_do_not_change_the_bytes() {
    let bench = Bench::new();
    let bytes = bench.bake_square();
    for threads in ["1", "5"] {
        let mut command = bench.command(&["bake", "-", "-o", "-", "--threads", threads]);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut stdin = child.stdin.take().expect("a pipe");
        stdin
            .write_all(SQUARE.as_bytes())
            .expect("the command reads");
        drop(stdin);
        let output = child.wait_with_output().expect("the command ends");
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert!(output.stdout == bytes, "{threads} threads: other bytes");
    }
    for cached in [false, true] {
        let arguments = [
            "bake",
            "square.svg",
            "-o",
            "again.vtex",
            "--cache-dir",
            "kept",
            "--format",
            "json",
        ];
        let output = bench.run(&arguments);
        assert_eq!(json(&output)[0]["cached"], cached, "{}", stderr(&output));
        assert!(
            fs::read(bench.path("again.vtex")).unwrap() == bytes,
            "other bytes"
        );
    }
    let other = [
        "bake",
        "square.svg",
        "-o",
        "x.vtex",
        "--cache-dir",
        "kept",
        "--size",
        "64",
    ];
    assert_eq!(code(&bench.run(&other)), 0);
    assert_eq!(
        fs::read_dir(bench.path("kept")).unwrap().count(),
        2,
        "options make another key"
    );
}

#[test]
fn check_compares_and_writes_nothing() {
    let bench = Bench::new();
    let check = ["bake", "square.svg", "-o", "square.vtex", "--check"];
    bench.fails(&check, 7, "missing or different");
    let bytes = bench.bake_square();
    assert_eq!(code(&bench.run(&check)), 0);
    bench.put("square.svg", SQUARE.replace("d03020", "d03021").as_bytes());
    bench.fails(&check, 7, "missing or different");
    assert!(
        fs::read(bench.path("square.vtex")).unwrap() == bytes,
        "--check wrote"
    );
}

#[test]
fn a_depfile_names_what_outputs_hang_on() {
    let bench = Bench::new();
    let arguments = [
        "bake",
        "square.svg",
        "-o",
        "square.vtex",
        "--depfile",
        "square.d",
    ];
    assert_eq!(code(&bench.run(&arguments)), 0);
    let text = fs::read_to_string(bench.path("square.d")).unwrap();
    assert_eq!(text, "square.vtex: square.svg\nsquare.svg:\n");
}

#[test]
fn info_preview_extract_and_compare_tell_what_is_there() {
    let bench = Bench::new();
    bench.bake_square();
    let info = json(&bench.run(&["info", "square.vtex", "--format", "json"]));
    assert_eq!(info["shapes"][0]["element"], "square");
    assert_eq!(info["shapes"][0]["coverage"], "curves");
    assert_eq!(info["warnings"], serde_json::json!([]));
    assert_eq!(info["shapes"][0]["finding"], "quantisation");
    assert_eq!(info["shapes"][0]["p99_px"], serde_json::Value::Null);
    let lookups = &info["lookups"];
    assert!(lookups["entries_mean"].as_f64().unwrap() > 0.0, "{lookups}");
    assert!(
        lookups["segments_mean"].as_f64().unwrap() > 0.0,
        "{lookups}"
    );
    let text = bench.run(&["info", "square.vtex"]);
    let text = String::from_utf8_lossy(&text.stdout);
    for words in [
        "1 shape in painter's order",
        "OUTL",
        "with BC7",
        "a raster of 2048",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }

    let arguments = [
        "preview",
        "square.vtex",
        "-o",
        "p.png",
        "--size",
        "8",
        "--spp",
        "1",
    ];
    assert_eq!(code(&bench.run(&arguments)), 0);
    let decoder = png::Decoder::new(std::io::BufReader::new(
        fs::File::open(bench.path("p.png")).unwrap(),
    ));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // Row 3: column 0 lies outside the square, column 3 inside.
    assert_eq!(pixels[(3 * 8) * 4..][..4], [0, 0, 0, 0]);
    assert_eq!(pixels[(3 * 8 + 3) * 4..][..4], [0xd0, 0x30, 0x20, 0xff]);

    let tiles = ["bake", "square.svg", "-o", "tiles.vtex", "--mode", "msdf"];
    assert_eq!(code(&bench.run(&tiles)), 0);
    assert_eq!(
        code(&bench.run(&["extract", "tiles.vtex", "-o", "parts"])),
        0
    );
    for name in [
        "layer-000-msdf.png",
        "cells-entries.png",
        "cells-segments.png",
        "cells.json",
        "shader.wgsl",
        "batch.spv",
    ] {
        assert!(bench.path("parts").join(name).exists(), "{name}");
    }

    let legend = fs::read(bench.path("parts").join("cells.json")).unwrap();
    let legend: serde_json::Value = serde_json::from_slice(&legend).unwrap();
    for what in ["entries", "segments"] {
        assert_eq!(legend[what]["lists"].as_array().unwrap().len(), 6, "{what}");
    }

    let compare = [
        "compare",
        "square.svg",
        "square.vtex",
        "--size",
        "64",
        "--zoom",
        "1,8",
    ];
    let report = bench.run(&[&compare[..], &["--format", "json", "--min-psnr", "30"]].concat());
    assert_eq!(code(&report), 0, "{}", stderr(&report));
    let zooms = json(&report)["zooms"].clone();
    assert_eq!(zooms[1]["windows"].as_array().unwrap().len(), 4);
    let strict = bench.run(&[&compare[..], &["--min-psnr", "119"]].concat());
    assert_eq!(code(&strict), 7, "{}", stderr(&strict));
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let bench = Bench::new();
    bench.bake_square();
    let mut child = bench
        .command(&["info", "square.vtex"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the command ends");
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
}

#[test]
fn colours_and_matrices_reach_the_file() {
    let bench = Bench::new();
    let path = Path::new("t.vtex");
    let arguments = [
        "bake",
        "square.svg",
        "-o",
        "t.vtex",
        "--fill-color",
        "#00f8",
        "--address",
        "mirror",
        "--transform",
        "2,0,0,2,-.5,0",
        "--outline",
        "1.5",
        "--mask",
        "--smoothing",
        "0.1",
    ];
    let output = bench.run(&arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let info = json(&bench.run(&["info", path.to_str().unwrap(), "--format", "json"]));
    let sampler = &info["sampler"];
    assert_eq!(sampler["address"], serde_json::json!(["mirror", "mirror"]));
    assert_eq!(sampler["texture_matrix"][4], -0.5);
    assert_eq!(sampler["outline_texels"], 1.5);
    assert_eq!(sampler["mask"], true);
    assert_eq!(info["shapes"][0]["color"][2], 1.0);
}
