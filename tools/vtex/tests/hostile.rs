//! Drawings made to hang, abort or exhaust memory, through the built command: each ends with an
//! exit code and a line, and leaves nothing behind.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use tempfile::TempDir;
use vtex_format::{Limits, VtexFile};
use vtex_testing::Corpus;

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";

/// A folder of its own for each test, and the command run inside it.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("names are below the folder")).expect("a folder");
        fs::write(path, bytes).expect("a file can be written");
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vtex"));
        command
            .current_dir(&self.folder)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments)
            .output()
            .expect("the command starts")
    }

    /// Bakes `in.svg`, which must end with `wanted`, one line that holds `words`, and no output.
    fn fails(&self, arguments: &[&str], wanted: i32, words: &str) {
        let output = self.run(&[&["bake", "in.svg", "-o", "out.vtex"], arguments].concat());
        self.failed(&output, wanted, words);
    }

    fn failed(&self, output: &Output, wanted: i32, words: &str) {
        let text = stderr(output);
        assert_eq!(output.status.code(), Some(wanted), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(
            text.starts_with("vtex: in.svg: ") && text.contains(words),
            "{text}"
        );
        self.holds(&["in.svg"]);
    }

    /// The folder holds these names and no others, no temporary file either.
    fn holds(&self, wanted: &[&str]) {
        let entries = fs::read_dir(&self.folder).expect("the folder can be listed");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name())
            .map(|name| name.to_string_lossy().into_owned())
            .collect();
        names.sort();
        assert_eq!(names, wanted, "something was left behind");
    }
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// One path of many segments that all cross each other: minutes of work within every limit.
fn slow() -> String {
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 22
    };
    let points: String = (0..60_000)
        .map(|_| format!("L{} {}", next(), next()))
        .collect();
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1024 1024'>\
         <path fill-rule='evenodd' d='M0 0{points}z'/></svg>"
    )
}

/// Far more memory than bytes.
fn large() -> String {
    let shapes = "<path d='M0 0h1v1z'/>".repeat(200_000);
    format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>{shapes}</svg>")
}

#[test]
fn a_bake_that_takes_too_long_is_ended() {
    let bench = Bench::new();
    bench.put("in.svg", slow());
    bench.fails(
        &["--timeout", "1"],
        8,
        "not baked within 1 s; --timeout SECONDS",
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_bake_that_takes_too_much_memory_is_ended() {
    let bench = Bench::new();
    bench.put("in.svg", large());
    let limit = ["--max-memory", "64", "--threads", "2"];
    bench.fails(&limit, 8, "more than 64 MiB; --max-memory MIB");
    // The SVG itself has no room.
    let blanks = " ".repeat(60 << 20);
    bench.put("in.svg", format!("{blanks}{SQUARE}"));
    bench.fails(
        &["--max-memory", "32"],
        8,
        "more than 32 MiB; --max-memory MIB",
    );
    bench.put("in.svg", SQUARE);
    let output = bench.run(&["bake", "in.svg", "-o", "out.vtex", "--max-memory", "64"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn the_others_of_a_folder_are_baked_all_the_same() {
    let bench = Bench::new();
    let names = ["a", "b", "c", "d"];
    for (name, color) in names.iter().zip(["d03020", "111111", "222222", "333333"]) {
        bench.put(&format!("in/{name}.svg"), SQUARE.replace("d03020", color));
    }
    assert_eq!(
        bench.run(&["bake", "in", "-o", "alone"]).status.code(),
        Some(0)
    );
    bench.put("in/hog.svg", large());
    bench.put("in/slow.svg", slow());
    let limits = ["--timeout", "4", "--max-memory", "200", "--threads", "1"];
    let output = bench.run(&[&["bake", "in", "-o", "out"], &limits[..]].concat());
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(
        text.contains("hog.svg: limit exceeded: needs more than 200 MiB"),
        "{text}"
    );
    assert!(
        // Whichever it comes to first.
        text.contains("slow.svg: limit exceeded"),
        "{text}"
    );
    assert!(text.contains("4 of 6 baked, 2 failed"), "{text}");
    for name in names {
        let name = format!("{name}.vtex");
        let [one, other] = ["alone", "out"].map(|folder| bench.path(folder).join(&name));
        assert!(
            fs::read(one).unwrap() == fs::read(other).unwrap(),
            "{name}: other bytes"
        );
    }
}

/// The only child of a process, as soon as it is there.
#[cfg(target_os = "linux")]
fn child_of(parent: &Child) -> u32 {
    let parent = parent.id();
    for _ in 0..1000 {
        for entry in fs::read_dir("/proc")
            .expect("/proc can be listed")
            .flatten()
        {
            // `pid (name) state ppid ...`
            let Ok(stat) = fs::read_to_string(entry.path().join("stat")) else {
                continue;
            };
            let after_name = stat.rsplit(") ").next().unwrap_or_default();
            if after_name.split(' ').nth(1) == Some(&parent.to_string()) {
                return stat
                    .split(' ')
                    .next()
                    .and_then(|pid| pid.parse().ok())
                    .expect("a number");
            }
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("vtex started no process");
}

#[cfg(target_os = "linux")]
fn kill(pid: u32) {
    let status = Command::new("kill")
        .args(["-9", &pid.to_string()])
        .status()
        .expect("kill is there");
    assert!(status.success(), "{pid} was not there to be killed");
}

#[cfg(target_os = "linux")]
#[test]
fn a_bake_that_others_end_is_a_failure_of_its_file() {
    let bench = Bench::new();
    bench.put("in.svg", slow());
    let arguments = ["bake", "in.svg", "-o", "out.vtex"];
    let parent = bench.command(&arguments).spawn().expect("vtex starts");
    kill(child_of(&parent));
    let output = parent.wait_with_output().expect("vtex ends");
    bench.failed(&output, 4, "signal: 9");
}

#[cfg(target_os = "linux")]
#[test]
fn no_bake_outlives_the_command() {
    let bench = Bench::new();
    bench.put("in.svg", slow());
    let arguments = ["bake", "in.svg", "-o", "out.vtex"];
    let mut parent = bench.command(&arguments).spawn().expect("vtex starts");
    let child = child_of(&parent);
    kill(parent.id());
    parent.wait().expect("vtex ends");
    let gone = |pid: u32| {
        let stat = fs::read_to_string(format!("/proc/{pid}/stat"));
        // A zombie waits for whoever inherited it.
        stat.map_or(true, |stat| stat.contains(") Z "))
    };
    for _ in 0..500 {
        if gone(child) {
            return bench.holds(&["in.svg"]);
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    kill(child);
    panic!("the bake went on without the command");
}

/// A PNG of one red pixel.
fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[255, 0, 0]).expect("a pixel");
    writer.finish().expect("an end");
    bytes
}

fn image(href: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
         <image href='{href}' width='8' height='8'/></svg>"
    )
}

/// What a bake says about itself, and its depfile.
fn told(bench: &Bench, arguments: &[&str]) -> (serde_json::Value, String) {
    let fixed = ["bake", "svg/in.svg", "-o", "out.vtex", "--format", "json"];
    let output = bench.run(&[&fixed[..], &["--depfile", "out.d"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let depfile = fs::read_to_string(bench.path("out.d")).expect("a depfile");
    (json[0].clone(), depfile)
}

#[test]
fn images_are_read_only_below_the_folders_that_are_allowed() {
    let bench = Bench::new();
    for name in ["svg/images/a b.png", "svg/out.png", "images-2/out.png"] {
        bench.put(name, png());
    }
    #[cfg(unix)]
    {
        let link = bench.path("svg/images/link.png");
        std::os::unix::fs::symlink("../out.png", link).expect("a link");
        let link = bench.path("svg/images/folder");
        std::os::unix::fs::symlink("../../images-2", link).expect("a link");
    }
    let allowed = ["--allow-images", "svg/images"];
    let absolute = bench.path("svg/out.png");
    let absolute = absolute
        .to_str()
        .expect("a temporary folder with a plain name");
    for href in [
        "out.png",
        "images/../out.png",
        "images/%2e%2e/out.png",
        "../images-2/out.png",
        absolute,
        &format!("file://{absolute}"),
        "images/link.png",
        "images/folder/out.png",
        "images/none.png",
        "images",
        "http://127.0.0.1:9/a.png",
        "//127.0.0.1/a.png",
        "in.svg",
    ] {
        bench.put("svg/in.svg", image(href));
        let (json, depfile) = told(&bench, &allowed);
        assert_eq!(
            json["warnings"][0]["name"], "ImageNotLoaded",
            "{href}: {json}"
        );
        assert_eq!(depfile, "out.vtex: svg/in.svg\nsvg/in.svg:\n", "{href}");
    }
    bench.put("svg/in.svg", image("images/a%20b.png"));
    let (json, _) = told(&bench, &[]);
    assert_eq!(json["warnings"][0]["name"], "ImageNotLoaded", "{json}");
    let (json, depfile) = told(&bench, &allowed);
    assert_eq!(json["warnings"], serde_json::json!([]), "{json}");
    assert_eq!(json["shapes"], 1, "{json}");
    assert!(depfile.contains("images/a\\ b.png:\n"), "{depfile}");
    let none = bench.run(&["bake", "svg/in.svg", "-o", "x", "--allow-images", "none"]);
    assert_eq!(none.status.code(), Some(2), "{}", stderr(&none));
}

#[test]
fn an_image_that_is_its_own_svg_ends() {
    let bench = Bench::new();
    bench.put("svg/in.svg", image("in.svg"));
    let (json, _) = told(&bench, &["--allow-images", "."]);
    let text = json["warnings"].to_string();
    assert!(text.contains("only embedded images"), "{text}");
}

#[test]
fn the_cache_keeps_no_bake_that_hangs_on_other_files() {
    let bench = Bench::new();
    bench.put("svg/in.svg", image("a.png"));
    let allowed = ["--allow-images", "svg", "--cache-dir", "kept"];
    let (missing, _) = told(&bench, &allowed);
    bench.put("svg/a.png", png());
    let (there, _) = told(&bench, &allowed);
    assert_eq!(
        missing["warnings"][0]["name"], "ImageNotLoaded",
        "{missing}"
    );
    assert_eq!(there["warnings"], serde_json::json!([]), "{there}");
    assert_eq!(there["shapes"], 1, "{there}");
    assert_eq!(there["cached"], false, "{there}");
    bench.put("svg/in.svg", SQUARE);
    told(&bench, &allowed);
    let (again, _) = told(&bench, &allowed);
    assert_eq!(again["cached"], true, "{again}");
}

#[test]
fn fine_cells_that_lie_are_found() {
    let bench = Bench::new();
    bench.put("in.svg", SQUARE);
    let baked = bench.run(&["bake", "in.svg", "-o", "out.vtex", "--profile", "load"]);
    assert_eq!(baked.status.code(), Some(0), "{}", stderr(&baked));
    let valid = bench.run(&["validate", "out.vtex"]);
    assert_eq!(valid.status.code(), Some(0), "{}", stderr(&valid));
    let bytes = fs::read(bench.path("out.vtex")).expect("the bake");
    let mut file = VtexFile::parse(&bytes, &Limits::default()).expect("a sound file");
    // The last command's first word: an end of a segment.
    let end = file.fine.len() - 4;
    file.fine[end] ^= 1;
    bench.put(
        "lie.vtex",
        file.to_bytes().expect("the format knows no better"),
    );
    let lie = bench.run(&["validate", "lie.vtex"]);
    assert_eq!(lie.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&lie.stdout).contains("V5040 FINE"));
}

/// Exit codes that satisfy the "expected" column of `EXPECTED.tsv`.
fn codes(expected: &str) -> &'static [i32] {
    match expected.split([' ', ',', '/']).next() {
        Some("error") if !expected.contains(" or ") => &[3, 8],
        Some("ok") if !expected.contains(" or ") => &[0],
        // "error or bounded memory", "ok or clean limit", "bounded time", "refuse or time limit".
        _ => &[0, 3, 8],
    }
}

#[test]
#[expect(clippy::print_stdout, reason = "what was seen is wanted")]
fn every_hostile_file_of_the_corpus_gets_what_is_expected() {
    let Some(corpus) = Corpus::find("the hostile files of the corpus") else {
        return;
    };
    let folder = corpus.path("hostile");
    let table = String::from_utf8(corpus.read("hostile/EXPECTED.tsv")).expect("a table");
    let mut count = 0;
    for row in table.lines().skip(1) {
        let columns: Vec<&str> = row.split('\t').collect();
        let (name, expected) = (columns[0], columns[2]);
        let bench = Bench::new();
        let source = folder.join(name);
        let source = source.to_str().expect("a plain name");
        let begun = std::time::Instant::now();
        let output = bench.run(&[
            "bake",
            source,
            "-o",
            "out.vtex",
            "--timeout",
            "10",
            "--no-system-fonts",
            "-v",
        ]);
        let seconds = begun.elapsed().as_secs_f64();
        let text = stderr(&output);
        let last = text.lines().last().unwrap_or_default();
        let code = output.status.code();
        println!("{name}\t{expected}\t{code:?}\t{seconds:.2} s\t{last}");
        assert!(
            code.is_some_and(|code| codes(expected).contains(&code)),
            "{name}: {expected}, but {code:?}: {text}"
        );
        if code == Some(0) {
            bench.holds(&["out.vtex"]);
            let valid = bench.run(&["validate", "out.vtex"]);
            assert_eq!(valid.status.code(), Some(0), "{name}: {}", stderr(&valid));
        } else {
            assert!(last.starts_with("vtex: ") && last.contains(name), "{text}");
            bench.holds(&[]);
        }
        if ["29_external_file_href.svg", "30_self_image.svg"].contains(&name) {
            assert!(text.contains("only embedded images are drawn"), "{text}");
        }
        count += 1;
    }
    assert!(count >= 37, "{count} files");
}
