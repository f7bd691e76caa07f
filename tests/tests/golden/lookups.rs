//! Random lookups, which go where a picture's do not: beyond the canvas, with footprints of all
//! sizes and directions, in each filter mode.

use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, Gpu};
use vtex_tests::parity::Parities;
use vtex_truth::picture::hash;
use vtex_truth::texture::FilterMode;

use crate::eyes::Eyes;

/// Lookups compared between GPU and twin in each filter mode.
const COUNT: u32 = 20_000;

/// How the batch kernel and the twin differ; `point` is the file packed for [`FilterMode::Point`].
pub(crate) fn compare(gpu: &Gpu, file: &VtexFile, point: &Eyes) -> Parities {
    let queries: Vec<BatchQuery> = (0..COUNT).map(query).collect();
    let mut parities = Parities::default();
    parities.add(point.features, point.look_up(&queries).parity);
    for filter in [FilterMode::Footprint, FilterMode::Paper] {
        let eyes = Eyes::new(Some(gpu), file, filter);
        parities.add(eyes.features, eyes.look_up(&queries).parity);
    }
    parities
}

/// Random lookup `index`: uv a little beyond the canvas, footprints from none to a tenth of it.
fn query(index: u32) -> BatchQuery {
    let random = |lane: u64| {
        let bits = hash(u64::from(index) * 8 + lane) >> 40;
        // 24 bits are exact in f32.
        bits as f32 / 16_777_216.0
    };
    let uv = [random(0), random(1)].map(|r| r * 1.02 - 0.01);
    let size = if index.is_multiple_of(3) {
        0.0
    } else {
        0.1 * random(2).powi(6)
    };
    let turn = random(3) * std::f32::consts::TAU;
    let (sin, cos) = turn.sin_cos();
    let footprint = [cos, sin, -sin * random(4), cos * random(4)].map(|axis| axis * size);
    BatchQuery {
        uv,
        padding: [0.0; 2],
        footprint,
    }
}
