//! The judge: MSDF or curves for each shape.
//!
//! A shape becomes an MSDF if its error is within the bound and it costs less than curves. The size
//! of the MSDF lattice is decided too, because all shapes share it. The error is measured on the
//! tiles themselves, against exact inside tests ([`measure`]); the cost is estimated from the
//! outline ([`cost`]); [`choose`] weighs them. Decision 0008 has the reasons and figures.

use vtex_format::Finding;

use crate::{
    config::{BakeConfig, Mode},
    coverage::verdict::{Coverage, Judgement, Verdict},
    drawing::Drawing,
};

mod candidate;
mod choose;
mod cost;
mod measure;
#[cfg(test)]
mod tests;

use candidate::Candidate;

/// Texels of the smallest lattice that is tried.
const SMALLEST_SIZE: u32 = 32;

/// Judges every item. The result is the same at any number of threads.
pub(crate) fn judge(drawing: &Drawing, config: &BakeConfig) -> Judgement {
    let all = |verdict| Judgement {
        verdicts: vec![verdict; drawing.items.len()],
        msdf_size: config.msdf_size,
    };
    match config.mode {
        Mode::Curves => return all(Verdict::forced(Coverage::Curves)),
        Mode::Msdf | Mode::Raster => return all(Verdict::forced(Coverage::Msdf)),
        Mode::Auto => {}
    }
    // Distance outlines and forced merges are features of MSDFs alone.
    if config.outline_texels.is_some() || config.merge {
        return all(Verdict::forced(Coverage::Msdf));
    }
    let candidates: Vec<Candidate> = sizes(config.msdf_size)
        .into_iter()
        .map(|size| Candidate::new(drawing, config, size))
        .filter(Candidate::resolves)
        .collect();
    if candidates.is_empty() {
        let finding = Finding::Quantisation;
        return all(Verdict::unmeasured(Coverage::Curves, finding));
    }
    choose::choose(drawing, config, &candidates)
}

/// The sizes to try: 32, 48, 64, 96, 128, ... and `largest`, ascending. A size is that of the
/// canvas' longer side.
fn sizes(largest: u32) -> Vec<u32> {
    let doubled = std::iter::successors(Some(SMALLEST_SIZE), |size| size.checked_mul(2));
    let mut sizes: Vec<u32> = doubled
        .flat_map(|size| [size, size.saturating_add(size / 2)])
        .take_while(|&size| size < largest)
        .collect();
    sizes.push(largest);
    sizes
}
