//! Rays per second of the path tracer, with and without textures.

mod staged;

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use vtex_baker::Resources;
use vtex_format::VtexFile;
use vtex_runtime::{LoadOptions, Scene, TraceOptions, Tracer, scene};
use vtex_scenes::showroom;

pub(crate) use staged::staged_tables;

use super::{compared, left_out};
use crate::report::{Cell, Table};
use crate::subject::{Subject, rasterise, read};
use crate::timing::{Device, Effort, Timing, Trial};

/// Size of the film on a graphics card, and in software: a software driver traces about a million
/// rays per second, and a card is done with as many before its clock can tell.
const CARD_FILM: [u32; 2] = [1280, 720];
const SOFTWARE_FILM: [u32; 2] = [240, 160];
/// Samples per pixel in a run.
const SAMPLES: u32 = 4;
/// Longer side of the raster textures: a raster that a scene with several textures can afford.
const RASTER_SIZE: u32 = 1024;
/// Objects of the showroom that take a texture.
const SHOWROOM: usize = 4;

/// The showroom with the first files, then each file on a plane.
pub(crate) fn rays_table(
    device: &Device,
    subjects: &[(&Path, &Subject)],
    resources: &Resources,
    effort: Effort,
) -> Result<Table> {
    let film = film(device);
    let raster = format!("raster {RASTER_SIZE}^2");
    let columns = ["GPU, million rays/s", &raster, "vector", "no texture"];
    let mut table = Table::new("Rays of the path tracer", &columns);
    table.note(format!(
        "{} x {} pixels, {SAMPLES} samples each, up to {} bounces, ray-cone footprints. The raster \
         is a canvas image with mips, behind the same evaluator and sampler: the tracer takes no \
         other texture.",
        film[0],
        film[1],
        TraceOptions::default().max_bounces,
    ));
    let mut rasters = Vec::new();
    for (path, subject) in subjects {
        let image = rasterise(&read(path)?, resources, RASTER_SIZE);
        let mut meta = subject.file.meta.clone();
        meta.curve_lattice = None;
        let file = VtexFile::of_image(meta, image.with_context(|| subject.name.clone())?, false);
        let issues = file.check();
        ensure!(issues.is_empty(), "{}: {issues:?}", subject.name);
        rasters.push(file);
    }
    let vectors: Vec<VtexFile> = subjects
        .iter()
        .map(|(_, subject)| subject.file.clone())
        .collect();
    let few = |files: &[VtexFile]| files.iter().take(SHOWROOM).cloned().collect();
    let rooms = [
        showroom(few(&rasters)),
        showroom(few(&vectors)),
        showroom(Vec::new()),
    ];
    table.row(row(device, "showroom", &rooms, effort)?);
    let files = rasters.into_iter().zip(vectors).zip(subjects);
    for (index, ((raster, vector), (_, subject))) in files.enumerate() {
        if effort.is_over() {
            table.note(left_out(subjects[index..].iter().map(|(_, rest)| *rest)));
            break;
        }
        let mut bare = scene::plane(vector.clone(), LoadOptions::default());
        bare.textures.clear();
        bare.materials
            .iter_mut()
            .for_each(|material| material.texture = None);
        let planes = [
            scene::plane(raster, LoadOptions::default()),
            scene::plane(vector, LoadOptions::default()),
            bare,
        ];
        table.row(row(
            device,
            &format!("plane, {}", subject.name),
            &planes,
            effort,
        )?);
    }
    Ok(table)
}

fn film(device: &Device) -> [u32; 2] {
    match device.is_software() {
        true => SOFTWARE_FILM,
        false => CARD_FILM,
    }
}

fn row(device: &Device, name: &str, scenes: &[Scene], effort: Effort) -> Result<Vec<Cell>> {
    let mut tracers = Vec::new();
    for scene in scenes {
        let options = TraceOptions::for_samples(SAMPLES);
        let mut tracer = Tracer::new(&device.device, &device.queue, scene, film(device), &options)?;
        tracer.accumulate(SAMPLES)?;
        let rays = tracer.stats()?.rays;
        tracers.push((tracer, usize::try_from(rays)?));
    }
    let trials = tracers
        .iter_mut()
        .map(|(tracer, rays)| Trial::timed(*rays, || trace(tracer)))
        .collect();
    let timings = effort.interleave(trials)?;
    let mut cells = vec![Cell::Text(name.to_owned())];
    cells.extend(compared(&timings, Timing::millions_a_second));
    Ok(cells)
}

/// The same paths every time, so the same number of rays.
fn trace(tracer: &mut Tracer) -> Result<Duration> {
    tracer.reset();
    let before = tracer.stats()?.device_ns;
    let start = Instant::now();
    tracer.accumulate(SAMPLES)?;
    let wall = start.elapsed();
    let after = tracer.stats()?.device_ns;
    Ok(before
        .zip(after)
        .map_or(wall, |(before, after)| Duration::from_nanos(after - before)))
}
