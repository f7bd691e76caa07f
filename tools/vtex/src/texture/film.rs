//! Path-traced pictures of scenes with textures.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{Image, Vec2, WritableImage};
use vtex_format::VtexFile;
use vtex_runtime::{
    Film, FilterMode, Gpu, LoadOptions, Scene, ToneMap, TraceOptions, Tracer, scene,
};
use vtex_scenes::showroom;
use vtex_truth::picture::encode_png;

use crate::cli::{Console, ExitCode, Failure, Outcome};
use crate::files;

/// What is in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SceneKind {
    /// The first texture on a plane, seen straight on.
    Plane,
    /// All textures on the objects of a showroom.
    Showroom,
    /// What a glTF asset shows.
    Asset,
}

/// How a picture is traced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Width and height of the film in pixels.
    pub(crate) size_px: [u32; 2],
    /// Samples per pixel.
    pub(crate) spp: u32,
    /// How lookups of the textures filter.
    pub(crate) filter: FilterMode,
    /// Most bounces of a path.
    pub(crate) bounces: u32,
    /// Seed of the random numbers.
    pub(crate) seed: u32,
    /// What is in the picture.
    pub(crate) kind: SceneKind,
}

/// Samples for each step of the progress bar.
const SAMPLES_A_STEP: u32 = 4;

/// Traces a picture of `files`.
///
/// # Errors
/// When there is no GPU, when it fails, or when the textures do not fit into its limits.
pub(crate) fn trace(files: Vec<VtexFile>, settings: Settings, console: Console) -> Outcome<Film> {
    let scene = match (settings.kind, files.first()) {
        (SceneKind::Plane, Some(file)) => scene::plane(file.clone(), LoadOptions::default()),
        _ => showroom(files),
    };
    trace_scene(scene, settings, console)
}

/// Traces a picture of `scene`.
///
/// # Errors
/// As [`trace`].
pub(crate) fn trace_scene(mut scene: Scene, settings: Settings, console: Console) -> Outcome<Film> {
    let gpu = Gpu::headless()?;
    console.detail(&format!("tracing on {}", gpu.adapter_name()));
    check_size(settings.size_px, &gpu)?;
    for (_, options) in &mut scene.textures {
        options.pack.filter = settings.filter;
    }
    let options = TraceOptions {
        max_bounces: settings.bounces,
        seed: settings.seed,
        ..TraceOptions::for_samples(settings.spp)
    };
    let mut tracer = Tracer::new(&gpu.device, &gpu.queue, &scene, settings.size_px, &options)?;
    let stats = tracer.stats()?;
    console.detail(&format!(
        "{} triangles in {} bytes on the device",
        stats.triangles, stats.geometry_bytes
    ));
    if stats.dropped_triangles > 0 {
        console.note(&format!(
            "{} triangles are too small, too large or without area, and were left out",
            stats.dropped_triangles
        ));
    }
    let steps = settings.spp.div_ceil(SAMPLES_A_STEP);
    let progress = console.progress(u64::from(steps), "tracing");
    while tracer.samples() < settings.spp {
        let left = settings.spp - tracer.samples();
        tracer.accumulate(left.min(SAMPLES_A_STEP))?;
        progress.step();
    }
    Ok(tracer.read()?)
}

/// Refuses a film that the GPU cannot bind, by the name of the option to change.
fn check_size([width, height]: [u32; 2], gpu: &Gpu) -> Outcome<()> {
    const BYTES_PER_PIXEL: u64 = 16;
    let limit = gpu.device.limits().max_storage_buffer_binding_size;
    let most = limit / BYTES_PER_PIXEL;
    if u64::from(width) * u64::from(height) <= most {
        return Ok(());
    }
    Err(Failure::new(
        ExitCode::Limit,
        format!("--size: {width} x {height} pixels are more than the {most} that this GPU binds"),
    ))
}

/// The film as a file of the kind that the extension of `path` names. `.png` is sRGB, tone-mapped for
/// the showroom, whose light is brighter than white paper. `.exr` is linear radiance,
/// premultiplied, as 32-bit floats.
///
/// # Errors
/// When the extension is another one.
pub(crate) fn encode(film: &Film, kind: SceneKind, path: &Path) -> Outcome<Vec<u8>> {
    match files::extension(path).as_str() {
        "png" => {
            let tone_map = match kind {
                // Colours under white light as they are.
                SceneKind::Plane | SceneKind::Asset => ToneMap::Clip,
                SceneKind::Showroom => ToneMap::Reinhard,
            };
            Ok(encode_png(
                film.size,
                &film.to_srgb8_with(1.0, tone_map),
                png::Compression::Balanced,
            )?)
        }
        "exr" => encode_exr(film),
        _ => Err(Failure::usage(format!(
            "{}: the output must be a .png or .exr file",
            path.display()
        ))),
    }
}

fn encode_exr(film: &Film) -> Outcome<Vec<u8>> {
    let [width, height] = film.size.map(|side| side as usize);
    let channels = exr::prelude::SpecificChannels::rgba(|Vec2(x, y): Vec2<usize>| {
        let [r, g, b, a] = film.pixels[y * width + x];
        (r, g, b, a)
    });
    let mut bytes = Cursor::new(Vec::new());
    Image::from_channels((width, height), channels)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| Failure::runtime(format!("cannot encode EXR: {error}")))?;
    Ok(bytes.into_inner())
}
