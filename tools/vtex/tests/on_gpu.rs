//! What `vtex info` says of a texture on a GPU.

use std::process::Command;

const SQUARE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 8 8'>\
    <path id='square' fill='#d03020' d='M1 1H6V7H1z'/></svg>";

#[test]
fn info_tells_what_a_texture_takes_on_a_gpu() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("square.svg"), SQUARE).expect("a file can be written");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_vtex"));
        let output = command.current_dir(&folder).args(arguments).output();
        output.expect("the command starts").stdout
    };
    run(&["bake", "square.svg", "-o", "square.vtex"]);
    let report = run(&["info", "square.vtex", "--format", "json"]);
    let info: serde_json::Value = serde_json::from_slice(&report).expect("stdout is JSON");
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
