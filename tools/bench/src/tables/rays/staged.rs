//! The path tracer in stages beside the one in a single kernel, for few and many textures.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use vtex_format::{Limits, VtexFile};
use vtex_runtime::{
    Camera, Instance, Integrator, LoadOptions, Material, Mesh, RectLight, RuntimeError, Scene, Sky,
    StageTime, TraceOptions, Tracer, parse_all,
};

use super::{SAMPLES, film, trace};
use crate::report::{Cell, Table};
use crate::tables::compared;
use crate::tables::set::changed;
use crate::timing::{Device, Effort, Timing, Trial};

/// How many textures a scene has.
const COUNTS: [usize; 3] = [1, 100, 1000];
const INTEGRATORS: [Integrator; 2] = [Integrator::Single, Integrator::Staged];

/// A scene with a tracer for each of [`INTEGRATORS`].
struct Wall {
    tracers: Vec<RefCell<Tracer>>,
    rays: usize,
    /// Of each integrator, the first time and the second.
    first_samples: Vec<[Duration; 2]>,
}

/// Rays a second and what is compiled, then the time of each stage.
pub(crate) fn staged_tables(
    device: &Device,
    files: &[(String, VtexFile)],
    effort: Effort,
) -> Result<Vec<Table>> {
    let columns = [
        "Textures",
        "kernels of lookups",
        "single, million rays/s",
        "staged, million rays/s",
        "single to first sample, ms",
        "once more",
        "staged to first sample, ms",
        "once more, staged",
    ];
    let mut table = Table::new("The path tracer in stages and in one kernel", &columns);
    table.note(format!(
        "{} drawings, repeated with other colours, on a wall of as many panels under a light, point mode, \
         {SAMPLES} samples. `to first sample`: from files that are parsed to the end of the first sample of \
         8 x 8 pixels: packing, upload, compiling. Once, in the order of the table; what an earlier row \
         compiled is not compiled again. `once more` compiles nothing where the driver keeps kernels, so the \
         difference is what compiling takes. Mesa also keeps them on disk, unless \
         `MESA_SHADER_CACHE_DISABLE=1`.",
        files.len()
    ));
    let mut walls = Vec::new();
    for count in COUNTS {
        match Wall::new(device, files, count) {
            Ok(wall) => walls.push((count, wall)),
            Err(error) if is_limit(&error) => {
                table.note(format!("{count} of these textures are refused: {error:#}."));
                break;
            }
            Err(error) => return Err(error),
        }
    }
    let mut stages = Table::new(
        "Stages of the path tracer",
        &["Textures", "stage", "ms", "share, %"],
    );
    stages.note(
        "Of one run as above, with a pass for each dispatch; without timestamps there are none.",
    );
    for (count, wall) in &walls {
        table.row(wall.row(*count, effort)?);
        wall.add_stages(*count, &mut stages)?;
    }
    Ok(vec![table, stages])
}

/// Whether textures do not fit the device: a figure too.
fn is_limit(error: &anyhow::Error) -> bool {
    matches!(error.downcast_ref(), Some(RuntimeError::Limit(_)))
}

fn options(integrator: Integrator) -> TraceOptions {
    TraceOptions {
        integrator,
        ..TraceOptions::for_samples(SAMPLES)
    }
}

fn first_sample(device: &Device, scene: &Scene, integrator: Integrator) -> Result<Duration> {
    let start = Instant::now();
    let options = options(integrator);
    let mut tracer = Tracer::new(&device.device, &device.queue, scene, [8, 8], &options)?;
    tracer.accumulate(1)?;
    Ok(start.elapsed())
}

impl Wall {
    fn new(device: &Device, files: &[(String, VtexFile)], count: usize) -> Result<Self> {
        let bytes = changed(files, count)?;
        let parsed = parse_all(&bytes, &Limits::default()).into_iter();
        let parsed: Vec<VtexFile> = parsed.collect::<Result<_, _>>().context("a file of ours")?;
        let scene = wall(parsed);
        let mut tracers = Vec::new();
        let mut rays = 0;
        let mut first_samples = Vec::new();
        for integrator in INTEGRATORS {
            let time = || first_sample(device, &scene, integrator);
            first_samples.push([time()?, time()?]);
            let mut tracer = Tracer::new(
                &device.device,
                &device.queue,
                &scene,
                film(device),
                &options(integrator),
            )?;
            tracer.accumulate(SAMPLES)?;
            rays = usize::try_from(tracer.stats()?.rays)?;
            tracers.push(RefCell::new(tracer));
        }
        Ok(Self {
            tracers,
            rays,
            first_samples,
        })
    }

    fn row(&self, count: usize, effort: Effort) -> Result<Vec<Cell>> {
        let trials = self
            .tracers
            .iter()
            .map(|tracer| Trial::timed(self.rays, move || trace(&mut tracer.borrow_mut())));
        let rays = effort.interleave(trials.collect())?;
        let kernels = self
            .tracers
            .iter()
            .map(|tracer| tracer.borrow().lookup_kernels());
        let mut cells = vec![
            Cell::Number(count as f64, 0),
            Cell::Number(kernels.max().unwrap_or(0) as f64, 0),
        ];
        cells.extend(compared(&rays, Timing::millions_a_second));
        let times = self.first_samples.as_flattened().iter();
        cells.extend(times.map(|time| Cell::Number(time.as_secs_f64() * 1e3, 0)));
        Ok(cells)
    }

    fn add_stages(&self, count: usize, table: &mut Table) -> Result<()> {
        for tracer in &self.tracers {
            let times: Vec<StageTime> = tracer.borrow_mut().accumulate_timed(SAMPLES)?;
            let whole: u64 = times.iter().map(|time| time.device_ns).sum();
            for time in times {
                table.row(vec![
                    Cell::Number(count as f64, 0),
                    Cell::Text(time.stage.to_owned()),
                    Cell::Number(time.device_ns as f64 / 1e6, 2),
                    Cell::Number(100.0 * time.device_ns as f64 / whole.max(1) as f64, 1),
                ]);
            }
        }
        Ok(())
    }
}

/// A wall that the camera sees all of, with a panel for each file, a floor and a light.
fn wall(files: Vec<VtexFile>) -> Scene {
    let columns = (files.len() as f32).sqrt().ceil();
    let side = 2.0 / columns;
    let place = |index: usize| {
        let [column, row] = [index as f32 % columns, (index as f32 / columns).floor()];
        [side * (column + 0.5) - 1.0, 1.0 - side * (row + 0.5), 0.0]
    };
    let floor = Material {
        base_color: [0.4; 3],
        ..Material::default()
    };
    let paper = |texture| Material {
        texture: Some(texture),
        backing: Some([0.8; 3]),
        ..Material::default()
    };
    let [x, y, z, _] = Instance::IDENTITY;
    let mut instances: Vec<Instance> = (0..files.len())
        .map(|index| Instance {
            mesh: 0,
            material: 1 + index,
            world_from_object: [x, y, z, place(index)],
        })
        .collect();
    instances.push(Instance {
        mesh: 1,
        material: 0,
        world_from_object: [x, [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [0.0, -1.0, 1.0]],
    });
    Scene {
        meshes: vec![Mesh::plane(side, side), Mesh::plane(6.0, 6.0)],
        instances,
        materials: std::iter::once(floor)
            .chain((0..files.len()).map(paper))
            .collect(),
        textures: files
            .into_iter()
            .map(|file| (file, LoadOptions::default()))
            .collect(),
        environment: None,
        punctual: Vec::new(),
        sky: Sky::uniform(0.6),
        lights: vec![RectLight {
            corner: [-0.5, 2.0, 1.0],
            edge_u: [1.0, 0.0, 0.0],
            edge_v: [0.0, 0.0, 1.0],
            radiance: [6.0; 3],
        }],
        camera: Camera {
            position: [0.0, 0.0, 3.4],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_y_rad: 0.65,
        },
    }
}
