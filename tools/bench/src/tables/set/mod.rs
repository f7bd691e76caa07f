//! Many textures in one pipeline: what they take, how long they load, what lookups cost.

mod many;

use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use vtex_format::{Limits, VtexFile};
use vtex_runtime::{
    FilterMode, GpuVtex, LoadOptions, LookupQueue, QueueBuffers, QueueSampler, RuntimeError,
    TextureHandle, TextureQuery, TextureSet, TextureSetOptions, parse_all,
};
use vtex_shaders::set::MAX_POOLS;

use super::compared;
use crate::report::{Cell, Table};
use crate::timing::{Device, Effort, Kernel, Screen, Spread, Timing, Trial, interleave};

pub(super) use many::changed;

/// How many textures share a pipeline, and how.
const ROWS: [Row; 6] = [
    Row::new(1, 1, u64::MAX),
    Row::new(10, 1, u64::MAX),
    Row::new(100, 1, u64::MAX),
    Row::new(100, MAX_POOLS, u64::MAX),
    Row::new(100, MAX_POOLS, 16 << 20),
    Row::new(1000, MAX_POOLS, u64::MAX),
];
/// Files of the table of single textures.
const SINGLE: usize = 10;
/// Queries of a queue that follow each other in one texture and lie close together: a workgroup's.
const RUN: usize = 64;
/// Rounds of compiling: pipelines take seconds.
const COMPILE_ROUNDS: usize = 3;
/// Textures of which a load is timed once, without a warm-up, since it takes seconds.
const ONCE: usize = 100;

/// A set to measure.
#[derive(Clone, Copy)]
struct Row {
    textures: usize,
    max_pools: u32,
    pool_bytes: u64,
}

impl Row {
    const fn new(textures: usize, max_pools: u32, pool_bytes: u64) -> Self {
        Self {
            textures,
            max_pools,
            pool_bytes,
        }
    }

    fn options(self, threads: usize) -> TextureSetOptions {
        TextureSetOptions {
            threads,
            max_pools: self.max_pools,
            pool_bytes: self.pool_bytes,
            ..TextureSetOptions::every_feature(FilterMode::Point)
        }
    }

    fn name(self) -> String {
        let pools = match (self.max_pools, self.pool_bytes) {
            (1, _) => String::new(),
            (_, u64::MAX) => ", pools".to_owned(),
            (_, bytes) => format!(", pools of {} MiB", bytes >> 20),
        };
        format!("{}{pools}", self.textures)
    }
}

/// A set with its files in memory, and queues of lookups in it.
struct Subject {
    row: Row,
    files: Vec<Vec<u8>>,
    set: TextureSet,
    sampler: QueueSampler,
    /// Lookups one after another in a texture, and each in another.
    queues: [LookupQueue; 2],
}

/// Rows are numbers of textures: those of `files`, and changed ones where they do not suffice.
pub(crate) fn set_tables(
    device: &Device,
    files: &[(String, VtexFile)],
    effort: Effort,
) -> Result<Vec<Table>> {
    let mut subjects = Vec::new();
    let mut refused = None;
    for row in ROWS {
        let files = changed(files, row.textures)?;
        match Subject::new(device, row, files, effort.gpu_lookups) {
            Ok(subject) => subjects.push(subject),
            Err(error) if is_limit(&error) => {
                let name = row.name();
                refused = Some(format!("{name}: these textures are refused: {error}."));
                break;
            }
            Err(error) => return Err(error),
        }
    }
    let columns = [
        "Textures",
        "pools",
        "files, KB",
        "words, MB",
        "texels, MB",
        "held, MB",
        "load, one core, ms",
        "load, all cores, ms",
        "pipeline, ms",
        "lookups in runs, M/s",
        "lookups at random, M/s",
    ];
    let mut table = Table::new("Many textures in one pipeline", &columns);
    table.note(format!(
        "{} drawings, repeated with other colours, in a `TextureSet` for point mode whose text has every \
         feature. MB are 10^6 bytes. `held`: buffer and pages. A load is from bytes in memory to the end of \
         the upload: parsing, hashing, decoding, packing; past {ONCE} textures it is timed once. `pipeline`: \
         the kernels of the queue and their first run. `pools`: a set that may have 32 pools, each of 128 MiB of \
         words at most or as said, whose queue is put in the order of pools first.",
        files.len()
    ));
    table.note(format!(
        "{} lookups of points from a queue by indirect dispatch, whose texture is chosen at random: in runs \
         of {RUN} within an eighth of a canvas, or for each anew. Ratios are to one texture.",
        effort.gpu_lookups
    ));
    if let Some(refused) = refused {
        table.note(refused);
    }
    let loads: Vec<[Spread; 2]> = subjects
        .iter()
        .map(|subject| subject.loads(device, effort.rounds))
        .collect::<Result<_>>()?;
    let pipelines = interleave(
        subjects.iter().map(|s| s.compiling(device)).collect(),
        COMPILE_ROUNDS,
    )?;
    let lookups = [0, 1].map(|queue| {
        let trials = subjects
            .iter()
            .map(|s| s.looking(device, queue, effort.gpu_lookups));
        effort.interleave(trials.collect())
    });
    let [runs, random] = lookups;
    let (runs, random) = (runs?, random?);
    let pipelines = compared(&pipelines, Timing::milliseconds);
    let runs = compared(&runs, Timing::millions_a_second);
    let random = compared(&random, Timing::millions_a_second);
    let measured = pipelines.zip(runs.zip(random));
    for ((subject, loads), (pipeline, (runs, random))) in subjects.iter().zip(loads).zip(measured) {
        let mut row = subject.sizes();
        row.extend(loads.map(|value| Cell::Measured { value, ratio: None }));
        row.extend([pipeline, runs, random]);
        table.row(row);
    }
    Ok(vec![table, handle_table(device, files, effort)?])
}

/// Whether textures do not fit the device: a figure too.
fn is_limit(error: &anyhow::Error) -> bool {
    matches!(error.downcast_ref(), Some(RuntimeError::Limit(_)))
}

impl Subject {
    fn new(device: &Device, row: Row, files: Vec<Vec<u8>>, lookups: usize) -> Result<Self> {
        let set = load(device, &files, &row.options(0))?;
        let sampler = QueueSampler::new(&device.device, &set)?;
        let handles: Vec<TextureHandle> = set.handles().collect();
        let queue = |run| queue(device, &sampler, &many::queries(&handles, lookups, run));
        let queues = [queue(RUN)?, queue(1)?];
        Ok(Self {
            row,
            files,
            set,
            sampler,
            queues,
        })
    }

    fn sizes(&self) -> Vec<Cell> {
        let bytes = self.set.bytes();
        let files: usize = self.files.iter().map(Vec::len).sum();
        let megabytes = |bytes: u64| Cell::Number(bytes as f64 / 1e6, 2);
        vec![
            Cell::Text(self.row.name()),
            Cell::Number(self.set.pools().len() as f64, 0),
            Cell::Number(files as f64 / 1e3, 0),
            megabytes(bytes.words),
            megabytes(bytes.texels),
            megabytes(bytes.words_held + bytes.texels_held),
        ]
    }

    /// By one core and by all, in turn.
    fn loads(&self, device: &Device, rounds: usize) -> Result<[Spread; 2]> {
        let rounds = if self.files.len() >= ONCE { 1 } else { rounds };
        let mut seconds = [Vec::new(), Vec::new()];
        for _ in 0..rounds {
            for (threads, seconds) in [1, 0].into_iter().zip(&mut seconds) {
                let start = Instant::now();
                drop(load(device, &self.files, &self.row.options(threads))?);
                seconds.push(1e3 * start.elapsed().as_secs_f64());
            }
        }
        Ok(seconds.map(|seconds| Spread::of(seconds.into_iter())))
    }

    fn compiling<'a>(&'a self, device: &'a Device) -> Trial<'a> {
        Trial::timed(1, move || {
            let query = [TextureQuery::default()];
            let start = Instant::now();
            let sampler = QueueSampler::new(&device.device, &self.set)?;
            let queue = queue(device, &sampler, &query)?;
            run(device, &sampler, &self.set, &queue)?;
            Ok(start.elapsed())
        })
    }

    fn looking<'a>(&'a self, device: &'a Device, queue: usize, lookups: usize) -> Trial<'a> {
        let queue = &self.queues[queue];
        Trial::timed(lookups, move || {
            run(device, &self.sampler, &self.set, queue)
        })
    }
}

/// A set of files, and the end of its upload.
fn load(device: &Device, files: &[Vec<u8>], options: &TextureSetOptions) -> Result<TextureSet> {
    let limits = Limits::default();
    let files: Vec<VtexFile> = match options.threads {
        1 => files
            .iter()
            .map(|bytes| VtexFile::parse(bytes, &limits))
            .collect::<Result<_, _>>()?,
        _ => parse_all(files, &limits)
            .into_iter()
            .collect::<Result<_, _>>()?,
    };
    let mut set = TextureSet::new(&device.device, &device.queue, options)?;
    let loaded = LoadOptions::default();
    set.add_all(files.iter().map(|file| (file, &loaded)))?;
    device.finish()?;
    Ok(set)
}

/// All of these queries.
fn queue(device: &Device, sampler: &QueueSampler, queries: &[TextureQuery]) -> Result<LookupQueue> {
    let usage = wgpu::BufferUsages::STORAGE;
    let count = u32::try_from(queries.len()).context("too many queries")?;
    let colors = device.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16 * u64::from(count),
        usage,
        mapped_at_creation: false,
    });
    let queries = device.buffer(bytemuck::cast_slice(queries), usage);
    let count = device.buffer(bytemuck::bytes_of(&count), usage);
    Ok(sampler.queue(&QueueBuffers {
        queries: queries.as_entire_buffer_binding(),
        count: count.as_entire_buffer_binding(),
        colors: colors.as_entire_buffer_binding(),
    })?)
}

fn run(
    device: &Device,
    sampler: &QueueSampler,
    set: &TextureSet,
    queue: &LookupQueue,
) -> Result<Duration> {
    let mut encoder = device.device.create_command_encoder(&Default::default());
    sampler.record(&mut encoder, set, queue)?;
    let commands = encoder.finish();
    let start = Instant::now();
    device.queue.submit([commands]);
    device.finish()?;
    Ok(start.elapsed())
}

/// What the way through a handle costs: each file alone, and as the only one of a set.
fn handle_table(device: &Device, files: &[(String, VtexFile)], effort: Effort) -> Result<Table> {
    let columns = [
        "8x all over, M/s",
        "alone",
        "by handle",
        "by handle, every feature",
    ];
    let mut table = Table::new("A texture alone and in a set", &columns);
    table.note(
        "Lookups of points. `alone`: the text of `GpuVtex`. `by handle`: that of a set with this texture \
         alone, and one with every feature.",
    );
    for (name, file) in files.iter().take(SINGLE) {
        let options = LoadOptions::default();
        let texture = GpuVtex::upload(&device.device, &device.queue, file, &options)?;
        let alone = kernel(
            device,
            &(texture.wgsl_fragment(0, 0) + include_str!("../../wgsl/vtex.wgsl")),
            (texture.buffer(), texture.texels(), texture.sampler()),
        );
        let [own, every] = [
            TextureSetOptions::default(),
            TextureSetOptions::every_feature(FilterMode::Point),
        ]
        .map(|options| in_set(device, file, &options));
        let kernels = [alone, own?, every?];
        let queries = Screen::new(file.meta.canvas_size).tour(effort.gpu_lookups);
        let batch = device.batch(&queries);
        let trials = kernels
            .iter()
            .map(|kernel| Trial::timed(queries.len(), || device.time(kernel, &batch)));
        let timings = effort.interleave(trials.collect())?;
        let mut row = vec![Cell::Text(name.clone())];
        row.extend(compared(&timings, Timing::millions_a_second));
        table.row(row);
    }
    Ok(table)
}

fn in_set(device: &Device, file: &VtexFile, options: &TextureSetOptions) -> Result<Kernel> {
    let mut set = TextureSet::new(&device.device, &device.queue, options)?;
    let handle = set.add(file, &LoadOptions::default())?.to_bits();
    let bridge = format!(
        "fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {{\n    \
         return vtex_sample({handle}u, uv, footprint);\n}}\n"
    );
    let text = set.wgsl_fragment(0, 0) + &bridge;
    let bound = (set.buffer(), set.texels(), set.sampler());
    Ok(kernel(device, &text, bound))
}

fn kernel(
    device: &Device,
    text: &str,
    (words, texels, sampler): (&wgpu::Buffer, &wgpu::TextureView, &wgpu::Sampler),
) -> Kernel {
    let resources = [
        words.as_entire_binding(),
        wgpu::BindingResource::TextureView(texels),
        wgpu::BindingResource::Sampler(sampler),
    ];
    device.kernel(text, &resources)
}
