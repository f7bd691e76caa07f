//! `vtex render`.

use std::path::Path;
use std::time::Instant;

use serde_json::json;
use vtex_baker::BakeConfig;
use vtex_format::VtexFile;
use vtex_gltf::ReadOptions;
use vtex_truth::picture::View;

use super::gltf::beside;
use crate::baking::fonts::FontLibrary;
use crate::cli::args::{Render, spelled};
use crate::cli::{Console, ExitCode, Failure, Format, Outcome, Size};
use crate::files::{extension, input, lossy, output};
use crate::texture::film::{self, SceneKind, Settings};
use crate::{baking, texture};

/// Runs `vtex render`.
pub(super) fn run(args: Render, console: Console) -> Outcome<ExitCode> {
    // Checked before tracing, which takes minutes.
    if !["png", "exr"].contains(&extension(&args.output).as_str()) {
        let name = args.output.display();
        return Err(Failure::usage(format!(
            "{name}: the output must be a .png or .exr file"
        )));
    }
    output::check(&args.output)?;
    let begun = Instant::now();
    let fonts = FontLibrary::new(args.fonts.clone())?;
    if args.scene.iter().any(|path| is_asset(path)) {
        return asset(&args, &fonts, begun, console);
    }
    let files = args
        .scene
        .iter()
        .map(|path| load(path, &fonts))
        .collect::<Outcome<Vec<_>>>()?;
    let kind = match files.as_slice() {
        [_] if !args.showroom => SceneKind::Plane,
        _ => SceneKind::Showroom,
    };
    let size_px = match (args.size, kind, files.first()) {
        (size, SceneKind::Plane, Some(file)) => super::preview::size_px(size, View::WHOLE, file),
        (Size::Exact(size), ..) => size,
        // The camera of the showroom is framed for 3:2.
        (Size::Longer(longer), ..) => [longer, (longer * 2 / 3).max(1)],
    };
    let Render {
        spp,
        filter,
        bounces,
        seed,
        ..
    } = args;
    let settings = Settings {
        size_px,
        spp,
        filter: filter.into(),
        bounces,
        seed,
        kind,
    };
    let film = film::trace(files, settings, console)?;
    let bytes = film::encode(&film, kind, &args.output)?;
    output::write(&args.output, &bytes)?;
    let [width, height] = size_px;
    console.note(&format!(
        "{}: {width} x {height}, {spp} spp",
        args.output.display()
    ));
    if console.format == Format::Json {
        let inputs: Vec<String> = args.scene.iter().map(|path| lossy(path)).collect();
        console.json(&json!({
            "inputs": inputs, "output": lossy(&args.output), "bytes": bytes.len(),
            "size_px": size_px, "spp": spp, "filter": spelled(&filter), "bounces": bounces,
            "seed": seed, "showroom": kind == SceneKind::Showroom,
            "seconds": begun.elapsed().as_secs_f64(),
        }))?;
    }
    Ok(ExitCode::Ok)
}

fn is_asset(path: &Path) -> bool {
    ["glb", "gltf"].contains(&extension(path).as_str())
}

/// Renders a glTF scene.
fn asset(
    args: &Render,
    fonts: &FontLibrary,
    begun: Instant,
    console: Console,
) -> Outcome<ExitCode> {
    let [path] = args.scene.as_slice() else {
        return Err(Failure::usage(
            "one glTF file is rendered at a time, and nothing beside it",
        ));
    };
    let options = ReadOptions {
        scene: args.scene_index,
        variant: args.variant.clone(),
    };
    let asset = beside::read(path, &options, fonts)?;
    for warning in &asset.warnings {
        console.note(&format!("{}: {warning}", path.display()));
    }
    let size_px = match args.size {
        Size::Exact(size) => size,
        Size::Longer(longer) => [longer, (longer * 3 / 4).max(1)],
    };
    let aspect = size_px[0] as f32 / size_px[1] as f32;
    let camera = beside::camera(&asset, args.camera.as_deref(), aspect)?;
    let mut scene = asset.scene;
    scene.camera = camera;
    let settings = Settings {
        size_px,
        spp: args.spp,
        filter: args.filter.into(),
        bounces: args.bounces,
        seed: args.seed,
        kind: SceneKind::Asset,
    };
    let film = film::trace_scene(scene, settings, console)?;
    let bytes = film::encode(&film, settings.kind, &args.output)?;
    output::write(&args.output, &bytes)?;
    let [width, height] = size_px;
    let (output, spp) = (args.output.display(), args.spp);
    console.note(&format!("{output}: {width} x {height}, {spp} spp"));
    if console.format == Format::Json {
        console.json(&json!({
            "inputs": [lossy(path)], "output": lossy(&args.output), "bytes": bytes.len(),
            "size_px": size_px, "spp": spp, "filter": spelled(&args.filter),
            "bounces": args.bounces, "seed": args.seed, "showroom": false,
            "warnings": asset.warnings, "seconds": begun.elapsed().as_secs_f64(),
        }))?;
    }
    Ok(ExitCode::Ok)
}

/// Reads a `.vtex` file; bakes any other file as SVG.
fn load(path: &Path, fonts: &FontLibrary) -> Outcome<VtexFile> {
    let bytes = input::read(path)?;
    if extension(path) == "vtex" {
        texture::parse(path, &bytes)
    } else {
        baking::bake(path, &bytes, &BakeConfig::default(), fonts, &|_| ())
    }
}
