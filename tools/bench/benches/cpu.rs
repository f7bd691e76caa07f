//! The CPU's hot parts one by one, for work on one of them: `cargo bench -p vtex-bench`.
//! Comparisons with other ways to draw are in the binary.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use vtex_baker::{BakeConfig, Resources};
use vtex_format::{Limits, VtexFile};
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

/// The sample with the most overlapping shapes; it has no text, so no font matters.
const SAMPLE: &str = include_str!("../../../tests/data/svg/paper/peacock.svg");
/// Lookups an iteration, on a lattice over the canvas.
const SIDE: u16 = 128;
/// A pixel at 8x of a canvas shown at 512 pixels.
const CLOSE: f32 = 1.0 / 4096.0;

fn baked() -> VtexFile {
    vtex_baker::bake_observed(
        SAMPLE.as_bytes(),
        &BakeConfig::default(),
        &Resources::default(),
        &|_| (),
    )
    .expect("the sample bakes")
}

/// The twin in each filter mode, magnified so that cells answer, and through the mips.
fn lookups(c: &mut Criterion) {
    let file = baked();
    let mut group = c.benchmark_group("lookup");
    group.throughput(Throughput::Elements(u64::from(SIDE) * u64::from(SIDE)));
    let modes = [
        ("point", FilterMode::Point, CLOSE),
        ("footprint", FilterMode::Footprint, CLOSE),
        ("paper", FilterMode::Paper, CLOSE),
        ("minified", FilterMode::Footprint, 24.0 * CLOSE),
    ];
    for (name, filter, pixel) in modes {
        let packed = pack(
            &file,
            &PackOptions {
                filter,
                ..PackOptions::default()
            },
        );
        let sampler = Sampler::new(&packed);
        group.bench_function(name, |bench| bench.iter(|| lattice(&sampler, pixel)));
    }
}

fn lattice(sampler: &Sampler<'_>, pixel: f32) {
    let footprint = [pixel, 0.0, 0.0, pixel];
    for i in 0..SIDE * SIDE {
        let at = |k: u16| (f32::from(k) + 0.37) / f32::from(SIDE);
        black_box(sampler.sample(black_box([at(i % SIDE), at(i / SIDE)]), footprint));
    }
}

/// From a file's bytes to words that a lookup can read.
fn loading(c: &mut Criterion) {
    let file = baked();
    let bytes = file
        .to_bytes()
        .expect("the sample is in the format's limits");
    let mut group = c.benchmark_group("load");
    group.throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("parse", |bench| {
        bench.iter(|| VtexFile::parse(black_box(&bytes), &Limits::default()));
    });
    let options = PackOptions::default();
    group.bench_function("pack", |bench| {
        bench.iter_batched(|| &file, |file| pack(file, &options), BatchSize::LargeInput);
    });
}

criterion_group!(benches, lookups, loading);
criterion_main!(benches);
