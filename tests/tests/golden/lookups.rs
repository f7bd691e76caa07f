//! Random lookups, which go where a picture's do not: beyond the canvas, with footprints of all
//! sizes and directions, in each filter mode.

use vtex_format::VtexFile;
use vtex_runtime::{BatchQuery, Gpu};
use vtex_truth::picture::hash;
use vtex_truth::texture::FilterMode;

use crate::eyes::Eyes;

/// Lookups compared between GPU and twin in each filter mode.
const COUNT: u32 = 20_000;
/// Lookups of point mode that may differ more: points on an edge to the last bit of an f32.
const POINT_FLIPS: usize = 2;

/// An error where the batch kernel and the twin disagree; `point` is the file packed for
/// [`FilterMode::Point`].
pub(crate) fn compare(gpu: &Gpu, file: &VtexFile, point: &Eyes) -> Result<(), String> {
    let queries: Vec<BatchQuery> = (0..COUNT).map(query).collect();
    compare_in(FilterMode::Point, point, &queries, POINT_FLIPS)?;
    for filter in [FilterMode::Footprint, FilterMode::Paper] {
        compare_in(filter, &Eyes::new(Some(gpu), file, filter), &queries, 0)?;
    }
    Ok(())
}

fn compare_in(
    filter: FilterMode,
    eyes: &Eyes,
    queries: &[BatchQuery],
    allowed: usize,
) -> Result<(), String> {
    let answers = eyes.look_up(queries);
    let apart = answers.apart();
    match (apart.first(), &answers.gpu) {
        (Some(&first), Some(gpu)) if apart.len() > allowed => Err(format!(
            "{filter:?}: {} of {COUNT} random lookups differ; {:?}: GPU {:?}, twin {:?}",
            apart.len(),
            queries[first],
            gpu[first],
            answers.twin[first]
        )),
        _ => Ok(()),
    }
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
