//! Path-traced pictures of scenes with textures.

use std::io::Cursor;
use std::path::Path;
use std::time::{Duration, Instant};

use exr::prelude::{AttributeValue, Image, Text, Vec2, WritableImage};
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
    /// After this time no further sample is started.
    pub(crate) time_limit: Option<Duration>,
}

/// A picture and what it took.
#[derive(Debug)]
pub(crate) struct Traced {
    /// The picture.
    pub(crate) film: Film,
    /// Rays that were traced for it.
    pub(crate) rays: u64,
    /// How long that took.
    pub(crate) time: Duration,
}

/// Most samples a pixel between two looks at the clock.
const SAMPLES_A_STEP: u32 = 4;

/// Time between two counts of the rays, each of which reads a number for each pixel.
const COUNT_INTERVAL: Duration = Duration::from_secs(1);

/// A scene of `files`.
pub(crate) fn scene_of(files: Vec<VtexFile>, kind: SceneKind) -> Scene {
    match (kind, files.first()) {
        (SceneKind::Plane, Some(file)) => scene::plane(file.clone(), LoadOptions::default()),
        _ => showroom(files),
    }
}

/// Traces a picture of `scene`.
///
/// # Errors
/// When there is no GPU, when it fails, or when the textures do not fit into its limits.
pub(crate) fn trace(mut scene: Scene, settings: Settings, console: Console) -> Outcome<Traced> {
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
    for notice in tracer.notices() {
        console.note(notice);
    }
    if stats.dropped_triangles > 0 {
        console.note(&format!(
            "{} triangles are too small, too large or without area, and were left out",
            stats.dropped_triangles
        ));
    }
    let time = accumulate(&mut tracer, settings, console)?;
    Ok(Traced {
        film: tracer.read()?,
        rays: tracer.stats()?.rays,
        time,
    })
}

/// Takes the samples, and tells for how long.
fn accumulate(tracer: &mut Tracer, settings: Settings, console: Console) -> Outcome<Duration> {
    let Settings {
        spp, time_limit, ..
    } = settings;
    let progress = console.progress(u64::from(spp), "tracing");
    let begun = Instant::now();
    let mut counted = begun;
    // With a limit the pace has to be known first.
    let mut step = time_limit.map_or(SAMPLES_A_STEP, |_| 1);
    while tracer.samples() < spp {
        let step_begun = Instant::now();
        step = step.min(spp - tracer.samples());
        tracer.accumulate(step)?;
        progress.steps(u64::from(step));
        if progress.is_shown() && counted.elapsed() >= COUNT_INTERVAL {
            let rays = tracer.stats()?.rays;
            progress.say(format!("tracing {}", pace(rays, begun.elapsed())));
            counted = Instant::now();
        }
        let left = time_limit.map(|limit| limit.saturating_sub(begun.elapsed()));
        match left {
            Some(Duration::ZERO) => break,
            Some(left) => {
                let fit = samples_in(left, step, step_begun.elapsed());
                let expected = u64::from(tracer.samples()) + u64::from(fit);
                progress.expect(expected.min(u64::from(spp)));
                step = fit.min(SAMPLES_A_STEP);
            }
            None => step = SAMPLES_A_STEP,
        }
    }
    Ok(begun.elapsed())
}

/// How many samples begin within `left`, at least one, when `count` took `time`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and that is enough samples"
)]
fn samples_in(left: Duration, count: u32, time: Duration) -> u32 {
    let each = time.as_secs_f64() / f64::from(count.max(1));
    ((left.as_secs_f64() / each).ceil() as u32).max(1)
}

/// Rays a second, in words.
pub(crate) fn pace(rays: u64, time: Duration) -> String {
    let pace = rays as f64 / time.as_secs_f64().max(1e-9);
    let (pace, unit) = match pace {
        1e9.. => (pace / 1e9, "Grays/s"),
        1e6.. => (pace / 1e6, "Mrays/s"),
        _ => (pace / 1e3, "krays/s"),
    };
    // Three digits, as 99.95 becomes 100.0 with one behind the point.
    let digits = if pace < 99.95 { 1 } else { 0 };
    format!("{pace:.digits$} {unit}")
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

/// How the light of a film becomes the colours of a PNG.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grade {
    /// How light becomes colours.
    pub(crate) tone_map: ToneMap,
    /// Stops by which light is made stronger first.
    pub(crate) stops: f32,
}

/// The film as a file of the kind that the extension of `path` names. `.png` is sRGB after `grade`.
/// `.exr` is linear radiance, premultiplied, as 32-bit floats, whatever `grade` says; its attribute
/// `samples` tells how many a pixel has.
///
/// # Errors
/// When the extension is another one.
pub(crate) fn encode(film: &Film, grade: Grade, path: &Path) -> Outcome<Vec<u8>> {
    match files::extension(path).as_str() {
        "png" => Ok(encode_png(
            film.size,
            &film.to_srgb8_with(grade.stops.exp2(), grade.tone_map),
            png::Compression::Balanced,
        )?),
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
    let mut image = Image::from_channels((width, height), channels);
    let samples = AttributeValue::I32(i32::try_from(film.samples).unwrap_or(i32::MAX));
    let attributes = &mut image.layer_data.attributes;
    attributes.other.insert(Text::from("samples"), samples);
    image
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| Failure::runtime(format!("cannot encode EXR: {error}")))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels, ReadLayers};

    use super::*;

    #[test]
    fn a_limit_lets_samples_begin_until_it_is_over() {
        let seconds = Duration::from_secs_f64;
        assert_eq!(samples_in(seconds(10.0), 4, seconds(2.0)), 20);
        assert_eq!(samples_in(seconds(0.1), 4, seconds(2.0)), 1);
        assert_eq!(samples_in(seconds(10.0), 1, Duration::ZERO), u32::MAX);
    }

    #[test]
    fn the_pace_fits_before_the_bar() {
        assert_eq!(pace(1_500_000, Duration::from_secs(2)), "750 krays/s");
        assert_eq!(pace(3_000_000, Duration::from_secs(2)), "1.5 Mrays/s");
        assert_eq!(pace(9_000_000_000, Duration::from_secs(2)), "4.5 Grays/s");
        for rays in [0, 99_960, 99_960_000, 999_999, 999_999_999] {
            assert!(format!("tracing {}", pace(rays, Duration::from_secs(1))).len() <= 20);
        }
    }

    #[test]
    fn exr_keeps_the_light_as_it_is() {
        let film = Film {
            size: [2, 1],
            pixels: vec![[7.5, 0.25, 1e-4, 1.0], [0.0, 0.5, 0.125, 0.5]],
            samples: 9,
        };
        let grade = Grade {
            tone_map: ToneMap::AgX,
            stops: 3.0,
        };
        let bytes = encode(&film, grade, Path::new("x.exr")).expect("an EXR file");
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .rgba_channels(
                |size, _| vec![[0.0_f32; 4]; size.area()],
                |pixels, at, (r, g, b, a): (f32, f32, f32, f32)| pixels[at.x()] = [r, g, b, a],
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .expect("it can be read");
        let layer = image.layer_data;
        assert_eq!(layer.channel_data.pixels, film.pixels);
        let samples = &layer.attributes.other[&Text::from("samples")];
        assert_eq!(*samples, AttributeValue::I32(9));
    }
}
