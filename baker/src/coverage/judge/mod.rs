//! Which kind of coverage a shape gets: a distance field where that is good enough and costs no
//! more, else curves.

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

/// Smallest lattice that is tried.
const SMALLEST_SIZE: u32 = 32;

/// Judges every item of `drawing`. The same at any thread count.
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
    // Outlines around shapes and layers of shapes that touch are what distance fields are for.
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

/// 32, 48, 64, 96, 128, ... and `largest`, ascending. The lattice is one for the whole canvas,
/// because all cells of the grid share it: a size is that of the canvas' longer side.
fn sizes(largest: u32) -> Vec<u32> {
    let doubled = std::iter::successors(Some(SMALLEST_SIZE), |size| size.checked_mul(2));
    let mut sizes: Vec<u32> = doubled
        .flat_map(|size| [size, size.saturating_add(size / 2)])
        .take_while(|&size| size < largest)
        .collect();
    sizes.push(largest);
    sizes
}
