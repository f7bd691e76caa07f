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
use crate::cli::light::Tone;
use crate::cli::{Console, ExitCode, Failure, Format, Outcome, Size};
use crate::files::{extension, input, lossy, output};
use crate::texture::film::{self, Grade, SceneKind, Settings, Traced};
use crate::texture::panorama;
use crate::{baking, texture};

/// Runs `vtex render`.
pub(super) fn run(args: Render, console: Console) -> Outcome<ExitCode> {
    // Checked before tracing, which takes minutes.
    let name = args.output.display();
    match extension(&args.output).as_str() {
        "png" => {}
        "exr" if args.light.tone.is_none() && args.light.exposure.is_none() => {}
        "exr" => {
            return Err(Failure::usage(format!(
                "{name}: an .exr holds the light as it was traced; --tone and --exposure are for .png"
            )));
        }
        _ => {
            return Err(Failure::usage(format!(
                "{name}: the output must be a .png or .exr file"
            )));
        }
    }
    output::check(&args.output)?;
    let begun = Instant::now();
    let fonts = FontLibrary::new(args.fonts.clone())?;
    let (picture, kind) = if args.scene.iter().any(|path| is_asset(path)) {
        (asset(&args, &fonts, console)?, SceneKind::Asset)
    } else {
        drawings(&args, &fonts, console)?
    };
    finish(&args, &picture, kind, begun, console)?;
    Ok(ExitCode::Ok)
}

fn is_asset(path: &Path) -> bool {
    ["glb", "gltf"].contains(&extension(path).as_str())
}

/// A picture, and what was odd about its scene.
struct Picture {
    traced: Traced,
    warnings: Vec<String>,
}

fn settings(args: &Render, size_px: [u32; 2]) -> Settings {
    Settings {
        size_px,
        spp: args.spp,
        filter: args.filter.into(),
        bounces: args.bounces,
        seed: args.seed,
        time_limit: args.time_limit,
    }
}

/// Renders drawings on a plane or in the showroom.
fn drawings(args: &Render, fonts: &FontLibrary, console: Console) -> Outcome<(Picture, SceneKind)> {
    let files = args
        .scene
        .iter()
        .map(|path| load(path, fonts))
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
    let mut scene = film::scene_of(files, kind);
    panorama::surround(&mut scene, &args.surroundings)?;
    let picture = Picture {
        traced: film::trace(scene, settings(args, size_px), console)?,
        warnings: Vec::new(),
    };
    Ok((picture, kind))
}

/// Renders a glTF scene.
fn asset(args: &Render, fonts: &FontLibrary, console: Console) -> Outcome<Picture> {
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
    panorama::surround(&mut scene, &args.surroundings)?;
    Ok(Picture {
        traced: film::trace(scene, settings(args, size_px), console)?,
        warnings: asset.warnings,
    })
}

/// The tone map that nobody asked for. The colours of a drawing on a plane are exact, and its light
/// is never above white. Other scenes may have lights in view, and `AgX` keeps their shades.
fn usual_tone(kind: SceneKind) -> Tone {
    match kind {
        SceneKind::Plane => Tone::None,
        SceneKind::Showroom | SceneKind::Asset => Tone::Agx,
    }
}

/// Writes the picture, and says what it is.
fn finish(
    args: &Render,
    picture: &Picture,
    kind: SceneKind,
    begun: Instant,
    console: Console,
) -> Outcome<()> {
    let Traced { film, rays, time } = &picture.traced;
    let tone = args.light.tone.unwrap_or(usual_tone(kind));
    let stops = args.light.exposure.unwrap_or(0.0);
    let grade = Grade {
        tone_map: tone.into(),
        stops,
    };
    let bytes = film::encode(film, grade, &args.output)?;
    output::write(&args.output, &bytes)?;
    let [width, height] = film.size;
    let samples = match film.samples {
        samples if samples < args.spp => format!("{samples} of {} spp in --time-limit", args.spp),
        samples => format!("{samples} spp"),
    };
    let pace = film::pace(*rays, *time);
    let output = args.output.display();
    console.note(&format!("{output}: {width} x {height}, {samples}, {pace}"));
    if console.format == Format::Json {
        let inputs: Vec<String> = args.scene.iter().map(|path| lossy(path)).collect();
        // An EXR file has neither.
        let graded = extension(&args.output) == "png";
        console.json(&json!({
            "inputs": inputs, "output": lossy(&args.output), "bytes": bytes.len(),
            "size_px": film.size, "spp": args.spp, "samples": film.samples,
            "filter": spelled(&args.filter), "bounces": args.bounces, "seed": args.seed,
            "showroom": kind == SceneKind::Showroom,
            "tone": graded.then(|| spelled(&tone)), "exposure": graded.then_some(stops),
            "warnings": picture.warnings, "rays": rays, "trace_seconds": time.as_secs_f64(),
            "seconds": begun.elapsed().as_secs_f64(),
        }))?;
    }
    Ok(())
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
