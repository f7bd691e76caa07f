//! Lookups per second of vector textures, and of the raster textures they replace.

use std::hint::black_box;
use std::time::{Duration, Instant};

use anyhow::Result;
use vtex_runtime::{GpuVtex, LoadOptions};
use vtex_shaders::cpu::{LookupCost, Sampler};
use vtex_shaders::layout::BatchQuery;
use vtex_shaders::{FilterMode, PackOptions};

use super::left_out;
use super::rivals::nothing_kernel;
use crate::report::{Cell, Table};
use crate::subject::{
    BC7_SIZES, CpuRaster, RASTER_SIZE, Subject, filtered, hardware_kernel, modes,
};
use crate::timing::{Device, Effort, Kernel, QuerySet, Timing, Trial, interleave};

/// Lookups a run of what takes a software driver seconds.
const FEW_LOOKUPS: usize = 1 << 18;

/// One table for each query set. Rows are files, and the raster is the baseline.
pub(crate) fn gpu_tables(
    device: &Device,
    subjects: &[Subject],
    effort: Effort,
) -> Result<Vec<Table>> {
    let mut rows = Vec::new();
    let mut rest = None;
    for (index, subject) in subjects.iter().enumerate() {
        if effort.is_over() {
            rest = Some(left_out(&subjects[index..]));
            break;
        }
        let kernels = gpu_kernels(device, subject)?;
        for set in subject.query_sets(effort.gpu_lookups) {
            let few = set.shorter(FEW_LOOKUPS);
            let batches = [&set, &few].map(|set| (set.len(), device.batch(set)));
            let trials = kernels.iter().flatten().map(|(kernel, kind)| {
                let is_slow = *kind == Kind::SlowInSoftware && device.is_software();
                let (lookups, batch) = &batches[usize::from(is_slow)];
                Trial::timed(*lookups, || device.time(kernel, batch))
            });
            let mut timings = effort.interleave(trials.collect())?.into_iter();
            let timings = kernels
                .iter()
                .map(|kernel| kernel.as_ref().and_then(|_| timings.next()))
                .collect();
            rows.push((subject, set, timings));
        }
    }
    let raster = "sRGB8 with mips through the trilinear sampler";
    let about = match device.has_bc7() {
        true => format!("{raster}; BC7: the same texels and sampler"),
        false => format!("{raster}; BC7: this device has no such textures"),
    };
    let about = format!("{about}; bands: a loop over all shapes, without a grid");
    let mut tables = tables("Lookups on the GPU", &about, &gpu_columns(device), &rows);
    for table in &mut tables {
        rest.iter().for_each(|rest| table.note(rest));
    }
    Ok(tables)
}

/// Names of what [`gpu_kernels`] returns; the first is the baseline.
fn gpu_columns(device: &Device) -> Vec<String> {
    let mut columns = vec![format!("raster {RASTER_SIZE}^2")];
    columns.extend(modes().map(|(name, _)| name.to_owned()));
    if device.has_bc7() {
        columns.extend(BC7_SIZES.map(|size| format!("BC7 {size}^2")));
    }
    columns.extend(["bands", "no texture"].map(str::to_owned));
    columns
}

/// How a kernel fares without a graphics card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Usual,
    /// Software decodes a block of BC7 at each fetch, and goes through every shape for all lanes.
    SlowInSoftware,
}

/// The filter modes and the rivals; `None` where a rival does not take this drawing.
fn gpu_kernels(device: &Device, subject: &Subject) -> Result<Vec<Option<(Kernel, Kind)>>> {
    let usual = |kernel| Some((kernel, Kind::Usual));
    let slow = |kernel| (kernel, Kind::SlowInSoftware);
    let mut kernels = vec![usual(hardware_kernel(device, &subject.raster))];
    for (_, pack) in modes() {
        kernels.push(usual(vtex_kernel(device, subject, pack)?));
    }
    if device.has_bc7() {
        let textures = 0..BC7_SIZES.len();
        kernels.extend(textures.map(|first| Some(slow(subject.bc7().kernel(device, first)))));
    }
    kernels.push(subject.bands.kernel(device).map(slow));
    kernels.push(usual(nothing_kernel(device)));
    Ok(kernels)
}

/// As [`gpu_tables`] for the twin on `threads` threads.
pub(crate) fn cpu_tables(
    subjects: &[Subject],
    threads: usize,
    effort: Effort,
) -> Result<Vec<Table>> {
    let mut rows = Vec::new();
    for subject in subjects {
        let raster = CpuRaster::new(&subject.raster);
        let packed = modes().map(|(_, options)| subject.packed(&options));
        let samplers = packed.each_ref().map(Sampler::new);
        for set in subject.query_sets(effort.cpu_lookups) {
            let queries = set.queries();
            let baseline = || spread(&queries, threads, |query| raster.sample(query));
            let mut trials = vec![Trial::timed(set.len(), || Ok(baseline()))];
            for sampler in &samplers {
                let sample = |query: &BatchQuery| sampler.sample(query.uv, query.footprint);
                let queries = &queries;
                trials.push(Trial::timed(set.len(), move || {
                    Ok(spread(queries, threads, sample))
                }));
            }
            let timings = interleave(trials, effort.rounds)?;
            rows.push((subject, set, timings.into_iter().map(Some).collect()));
        }
    }
    let title = match threads {
        1 => "Lookups by the CPU twin, one core".to_owned(),
        _ => format!("Lookups by the CPU twin, {threads} cores"),
    };
    let baseline = "sRGB8 with mips, trilinear in Rust";
    let mut columns = vec![format!("raster {RASTER_SIZE}^2")];
    columns.extend(modes().map(|(name, _)| name.to_owned()));
    Ok(tables(&title, baseline, &columns, &rows))
}

/// What lookups of the twin and of the GPU read, and what the texture takes.
pub(crate) fn count_table(subjects: &[Subject], effort: Effort) -> Table {
    let columns = [
        "8x, random points of the canvas",
        "layers",
        "packed KiB",
        "raster KiB",
        "entries, point",
        "segments, point",
        "tiles, point",
        "bytes, point",
        "entries, footprint",
        "segments, footprint",
        "bytes, footprint",
    ];
    let mut table = Table::new("What a lookup reads", &columns);
    table.note(
        "Means over the lookups, counted along the twin's walk. The raster reads 16 to 32 bytes.",
    );
    for subject in subjects {
        let [.., set] = subject.query_sets(effort.cpu_lookups);
        let lookups = set.len() as f64;
        let sum = |filter| {
            let packed = subject.packed(&filtered(filter));
            let sampler = Sampler::new(&packed);
            let of = |query: BatchQuery| sampler.cost(query.uv, query.footprint);
            let costs = set.queries().into_iter().map(of);
            costs.fold(LookupCost::default(), std::ops::Add::add)
        };
        let [point, footprint] = [sum(FilterMode::Point), sum(FilterMode::Footprint)];
        let mean = |total: u32, digits| Cell::Number(f64::from(total) / lookups, digits);
        let kib = |bytes: usize| Cell::Number(bytes as f64 / 1024.0, 0);
        table.row(vec![
            Cell::Text(subject.name.clone()),
            Cell::Number(subject.file.layers.len() as f64, 0),
            kib(subject.packed(&filtered(FilterMode::Point)).bytes()),
            kib(subject.raster.mips.iter().map(Vec::len).sum()),
            mean(point.entries, 2),
            mean(point.segments, 2),
            mean(point.tiles, 2),
            mean(point.bytes, 1),
            mean(footprint.entries, 2),
            mean(footprint.segments, 2),
            mean(footprint.bytes, 1),
        ]);
    }
    table
}

pub(super) fn vtex_kernel(device: &Device, subject: &Subject, pack: PackOptions) -> Result<Kernel> {
    let options = LoadOptions {
        pack,
        ..LoadOptions::default()
    };
    let texture = GpuVtex::upload(&device.device, &device.queue, &subject.file, &options)?;
    let bridge = include_str!("../wgsl/vtex.wgsl");
    let resources = [
        texture.buffer().as_entire_binding(),
        wgpu::BindingResource::TextureView(texture.texels()),
        wgpu::BindingResource::Sampler(texture.sampler()),
    ];
    Ok(device.kernel(&[&texture.wgsl_fragment(0, 0), bridge].concat(), &resources))
}

/// Answers all queries on `threads` threads and returns how long that took.
fn spread(
    queries: &[BatchQuery],
    threads: usize,
    sample: impl Fn(&BatchQuery) -> [f32; 4] + Sync,
) -> Duration {
    let work = |queries: &[BatchQuery]| {
        for query in queries {
            black_box(sample(black_box(query)));
        }
    };
    let start = Instant::now();
    if threads == 1 {
        work(queries);
    } else {
        std::thread::scope(|scope| {
            for part in queries.chunks(queries.len().div_ceil(threads).max(1)) {
                scope.spawn(|| work(part));
            }
        });
    }
    start.elapsed()
}

/// Timings for a file and query set, one for each column; `None` where there is nothing to time.
/// The first is the baseline.
type Row<'a> = (&'a Subject, QuerySet, Vec<Option<Timing>>);

fn tables(title: &str, raster: &str, names: &[String], rows: &[Row<'_>]) -> Vec<Table> {
    let mut tables: Vec<(&str, Table)> = Vec::new();
    for (subject, set, timings) in rows {
        let place = tables
            .iter()
            .position(|(name, _)| *name == set.name)
            .unwrap_or_else(|| {
                let mut columns = vec!["million lookups/s"];
                columns.extend(names.iter().map(String::as_str));
                let mut table = Table::new(format!("{title}, {}", set.name), &columns);
                table.note(format!("{}; raster: {raster}.", meaning(set.name)));
                tables.push((set.name, table));
                tables.len() - 1
            });
        let mut cells = vec![Cell::Text(subject.name.clone())];
        let baseline = timings.first().and_then(Option::as_ref);
        cells.extend(timings.iter().enumerate().map(|(index, timing)| {
            let Some(timing) = timing else {
                return Cell::none();
            };
            Cell::Measured {
                value: timing.millions_a_second(),
                ratio: baseline
                    .filter(|_| index > 0)
                    .map(|base| timing.speed_against(base)),
            }
        }));
        tables[place].1.row(cells);
    }
    tables.into_iter().map(|(_, table)| table).collect()
}

/// What a query set of [`Subject::query_sets`] is.
fn meaning(name: &str) -> &'static str {
    match name {
        "8x, all" => {
            "Blocks of 64 x 64 pixels at 8x from everywhere on the canvas, in screen order"
        }
        "8x" => "The 512 x 512 pixels of the canvas' busiest part at 8x, in screen order",
        "1x" => "The whole canvas in 512 pixels, in screen order",
        _ => "Random points of the canvas with the footprint of a pixel at 8x",
    }
}
