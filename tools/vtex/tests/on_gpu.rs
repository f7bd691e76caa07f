//! What needs a GPU: pictures of `vtex render`, and what `vtex info` says of textures there.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";

#[test]
fn info_tells_what_a_texture_takes_on_a_gpu() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("square.svg"), SQUARE).expect("a file can be written");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vtex"));
        let output = command.current_dir(&folder).args(arguments).output();
        output.expect("the command starts").stdout
    };
    run(&["bake", "square.svg", "-o", "square.vtex"]);
    let report = run(&["info", "square.vtex", "--format", "json"]);
    let info: Value = serde_json::from_slice(&report).expect("stdout is JSON");
    let point = &info["gpu"]["point"];
    let count = |key: &str| point[key].as_u64().unwrap();
    assert_eq!(count("bytes"), count("words") + count("texels"));
    assert_eq!(info["gpu_bytes"], point["bytes"]);
    assert_eq!(info["gpu_bytes_bc"], point["bytes_bc"]);
    // Sides of pages need not be whole blocks.
    assert!((count("texels")..count("texels") + 16_384).contains(&(4 * count("texels_bc"))));
    assert_eq!(info["gpu"]["rasters"][0]["bytes"], 89_478_484);
    assert_eq!(info["gpu"]["rasters"][2]["bytes_bc"], 1_398_128);
    assert!(info["load_ms"]["parse"].as_f64().is_some(), "{info}");
}

/// Renders the square of a folder and returns what is said of the picture, and its bytes.
fn render(folder: &Path, name: &str, options: &str) -> (Value, Vec<u8>) {
    let line = format!("render square.svg -o {name} --size 16 --format json {options}");
    let mut command = Command::new(env!("CARGO_BIN_EXE_vtex"));
    let command = command.current_dir(folder).args(line.split_whitespace());
    let output = command.output().expect("the command starts");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{line}: {text}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("stdout is JSON");
    let bytes = fs::read(folder.join(name)).expect("a picture");
    assert_eq!(report["bytes"], bytes.len(), "{report}");
    assert!(report["rays"].as_u64() >= Some(256), "{report}");
    (report, bytes)
}

fn folder_for(what: &str) -> Option<tempfile::TempDir> {
    vtex_testing::gpu(what).then(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("square.svg"), SQUARE).expect("a file can be written");
        folder
    })
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let Some(folder) = folder_for("the bytes of vtex render") else {
        return;
    };
    // Six samples are a step of four and one of two.
    for (name, options) in [
        ("x.png", "--spp 6"),
        ("x.exr", "--spp 6"),
        ("x.png", "--spp 6 --showroom"),
    ] {
        let picture = |seed| render(folder.path(), name, &format!("{options} --seed {seed}")).1;
        assert!(picture(7) == picture(7), "{name} {options}");
        assert!(picture(7) != picture(8), "{name} {options}: no randomness");
    }
}

#[test]
fn a_time_limit_writes_what_there_is() {
    let Some(folder) = folder_for("the time limit of vtex render") else {
        return;
    };
    let most = 65_536;
    let limited = format!("--spp {most} --time-limit 0.001");
    let (report, _) = render(folder.path(), "x.png", &limited);
    let samples = report["samples"].as_u64().expect("a number");
    assert!((1..most).contains(&samples), "{report}");
    assert_eq!(report["spp"], most, "{report}");
    let (report, _) = render(folder.path(), "x.png", "--spp 3 --time-limit 1000");
    assert_eq!(report["samples"], 3, "{report}");
}

#[test]
fn a_drawing_keeps_its_colours_unless_told_otherwise() {
    let Some(folder) = folder_for("the tone maps of vtex render") else {
        return;
    };
    let folder = folder.path();
    let middle = |options: &str| {
        let (report, bytes) = render(folder, "x.png", options);
        let mut png = png::Decoder::new(std::io::Cursor::new(bytes));
        png.set_transformations(png::Transformations::EXPAND);
        let mut png = png.read_info().expect("a PNG file");
        let mut pixels = vec![0; png.output_buffer_size().expect("it is small")];
        let info = png.next_frame(&mut pixels).expect("a picture");
        let step = info.color_type.samples();
        let at = (8 * info.width as usize + 8) * step;
        (report["tone"].clone(), pixels[at..at + 3].to_vec())
    };
    // #d03020 is the fill.
    assert_eq!(middle(""), ("none".into(), vec![0xd0, 0x30, 0x20]));
    let (tone, dark) = middle("--exposure -1");
    assert_eq!(tone, "none");
    // Half the light of 208, 48 and 32 is 152, 32 and 20 by the curve of sRGB.
    for (shown, wanted) in dark.iter().zip([152_u8, 32, 20]) {
        assert!(shown.abs_diff(wanted) <= 1, "{dark:?}");
    }
    let (tone, agx) = middle("--tone agx");
    assert_eq!(tone, "agx");
    // Less saturated than it was.
    assert!(agx[0] < 0xd0 && agx[1] > 0x30 && agx[2] > 0x20, "{agx:?}");
    assert_ne!(middle("--tone aces").1, agx);
    assert_eq!(middle("--showroom").0, "agx");
}

/// The means of the four channels of a PNG.
fn means(bytes: Vec<u8>) -> [f64; 4] {
    let mut png = png::Decoder::new(std::io::Cursor::new(bytes));
    png.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
    let mut reader = png.read_info().expect("a picture");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a small picture")];
    reader.next_frame(&mut pixels).expect("a picture");
    let mut sums = [0.0; 4];
    for pixel in pixels.chunks_exact(4) {
        for (sum, &value) in sums.iter_mut().zip(pixel) {
            *sum += f64::from(value);
        }
    }
    sums.map(|sum| sum / (pixels.len() / 4) as f64)
}

#[test]
fn panoramas_and_skies_light_the_scene() {
    let Some(folder) = folder_for("panoramas of vtex render") else {
        return;
    };
    let folder = folder.path();
    let picture = |options: &str| means(render(folder, "x.png", options).1);
    let near = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 3.0);
    // White in eight by four pixels: mantissas of one half and an exponent of one.
    let mut white = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n".to_vec();
    white.extend([128, 128, 128, 129].repeat(32));
    fs::write(folder.join("white.hdr"), white).expect("a file can be written");
    let plain = picture("--spp 16");
    let lit = picture("--spp 64 --environment white.hdr --environment-turn -30");
    assert!(near(plain, lit), "{plain:?} {lit:?}");
    assert_eq!(picture("--sky 0"), [0.0, 0.0, 0.0, 255.0]);
    // A panorama that was rendered here, of a dark square before a grey sky. The camera sees the middle
    // of a panorama, unless it is turned.
    render(folder, "square.exr", "--sky 0.5 --bounces 0");
    let square = picture("--spp 16 --environment square.exr --bounces 0");
    assert!(square[0] < 1.0, "{square:?}");
    let turned = picture("--spp 16 --environment square.exr --bounces 0 --environment-turn 180");
    assert!(
        near(picture("--sky 0.5 --spp 16 --bounces 0"), turned),
        "{turned:?}"
    );
}
