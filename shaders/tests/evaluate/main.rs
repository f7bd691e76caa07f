//! The evaluator's twin on files built by hand, against plain formulas.
#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small numbers of test data"
)]

mod address;
mod builder;
mod curves;
mod footprints;
mod formula;
mod gradients;
mod images;
mod lists;
mod spec;

use vtex_format::VtexFile;
use vtex_shaders::cpu::Sampler;
use vtex_shaders::{FilterMode, PackOptions, pack};

const FILTERS: [FilterMode; 3] = [FilterMode::Point, FilterMode::Footprint, FilterMode::Paper];

/// Looks `file` up at `u`, in the middle of its row, with a square footprint of `width` in u.
fn sample(file: &VtexFile, filter: FilterMode, u: f32, width: f32) -> [f32; 4] {
    let options = PackOptions {
        filter,
        ..PackOptions::default()
    };
    let columns = file.meta.grid.size_cells[0] as f32;
    let packed = pack(file, &options);
    Sampler::new(&packed).sample([u, 0.5], [width, 0.0, 0.0, width * columns])
}

#[track_caller]
fn check(got: [f32; 4], expected: [f64; 4], tolerance: f64) {
    let close = |(got, expected): (&f32, &f64)| (f64::from(*got) - expected).abs() <= tolerance;
    assert!(
        got.iter().zip(&expected).all(close),
        "got {got:?}, expected {expected:?}"
    );
}
