//! Random lookups, which go where a picture's do not: beyond the canvas, with footprints of all
//! sizes and directions, in each filter mode.

use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, Gpu};
use vtex_shaders::cpu;
use vtex_truth::picture::hash;
use vtex_truth::texture::{FilterMode, Shooter, canvas_options};

/// Lookups compared between GPU and twin in each filter mode.
const COUNT: u32 = 20_000;
/// Largest difference of a channel, linear light, that counts as equal.
const SAME: f32 = 2.0 / 255.0;
/// Lookups of point mode that may differ more: points on an edge to the last bit of an f32.
const POINT_FLIPS: usize = 2;

/// An error where the batch kernel and the twin disagree.
pub(crate) fn compare(gpu: &Gpu, file: &VtexFile) -> Result<(), String> {
    let queries: Vec<BatchQuery> = (0..COUNT).map(query).collect();
    for filter in [FilterMode::Point, FilterMode::Footprint, FilterMode::Paper] {
        let pack = canvas_options(filter);
        let shooter = Shooter::on_gpu(gpu, file, pack).map_err(|error| error.to_string())?;
        let Shooter::Gpu { sampler } = shooter else {
            return Err("no batch sampler".to_owned());
        };
        let words = vtex_shaders::pack(file, &pack);
        let twin = cpu::Sampler::new(&words);
        let colors = sampler
            .sample(&queries)
            .map_err(|error| error.to_string())?;
        let expected = queries
            .iter()
            .map(|query| twin.sample(query.uv, query.footprint));
        let wrong: Vec<_> = queries
            .iter()
            .zip(colors.iter().zip(expected))
            .filter(|(_, (color, expected))| !same(color, expected, SAME))
            .collect();
        let allowed = match filter {
            FilterMode::Point => POINT_FLIPS,
            _ => 0,
        };
        if let Some((query, (color, expected))) = wrong.first().filter(|_| wrong.len() > allowed) {
            let count = wrong.len();
            return Err(format!(
                "{filter:?}: {count} of {COUNT} random lookups differ; \
                 {query:?}: GPU {color:?}, twin {expected:?}"
            ));
        }
    }
    Ok(())
}

/// Never for what is no number.
pub(crate) fn same(a: &[f32; 4], b: &[f32; 4], tolerance: f32) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
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
