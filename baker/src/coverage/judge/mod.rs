//! Which kind of coverage a shape gets: a distance field where that is good enough and costs no
//! more, else curves.

use vtex_format::{FieldError, Finding};

use crate::{
    config::{BakeConfig, Mode},
    coverage::{grid::Lattice, scales::Scales},
    drawing::{Drawing, Item, to_f32},
};

mod choose;
mod cost;
mod measure;
#[cfg(test)]
mod tests;

pub(crate) use choose::size_texels;

/// Pixels of the canvas' longer side at zoom 1.
pub(crate) const PIXELS_AT_ZOOM_1: f64 = 512.0;
/// Share of probes around the edge that a distance field may put on the wrong side.
const WRONG_SHARE_BOUND: f64 = 1e-3;
/// Steps of a stored distance over its range.
const QUANTA: f64 = 255.0;
/// Displacement by rounding alone in quanta, 99th percentile: 0.5 at most. Measured: 0.498 and more
/// on squares at 60 angles; a little less for outlines that lie on the lattice by luck. A lattice on
/// which even this is beyond the bound is not tried.
const ROUNDING_QUANTA: f64 = 0.4;
/// Bits of a float that reports keep: 7 of the mantissa.
const SHORT_FLOAT: u32 = 0xFFFF_0000;
/// Smallest lattice that is tried.
const SMALLEST_SIZE: u32 = 32;

/// How a shape covers cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// Tiles of a distance field.
    Msdf,
    /// Curve records.
    Curves,
}

/// A decision and what it rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Verdict {
    /// What the shape becomes.
    pub(crate) coverage: Coverage,
    /// Why it is no distance field, or what is wrong with it.
    pub(crate) finding: Finding,
    /// Longer side of the shape in texels of the lattice on which its field was judged; 0 where
    /// none was.
    pub(crate) size_texels: u32,
    /// How far the field is off, where it was measured.
    pub(crate) error: Option<FieldError>,
}

/// What becomes of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judgement {
    /// One an item; what it says of patches has no meaning.
    pub(crate) verdicts: Vec<Verdict>,
    /// Texels of the lattice of distance fields along the canvas' longer side.
    pub(crate) msdf_size: u32,
}

impl Verdict {
    /// A verdict that the mode gives.
    pub(crate) fn forced(coverage: Coverage) -> Self {
        Self::unmeasured(coverage, Finding::None)
    }

    /// A verdict without a measurement.
    pub(crate) fn unmeasured(coverage: Coverage, finding: Finding) -> Self {
        Self {
            coverage,
            finding,
            size_texels: 0,
            error: None,
        }
    }
}

/// A lattice of distance fields and what it means for them.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    size: u32,
    lattice: Lattice,
    scales: Scales,
    /// Pixels at the largest zoom a lattice step.
    px_per_step: f64,
    error_px: f64,
}

impl Candidate {
    fn new(drawing: &Drawing, config: &BakeConfig, mip0_size: u32, size: u32) -> Self {
        let lattice = Lattice::new(drawing.canvas_size, size);
        Self {
            size,
            lattice,
            scales: Scales::new(config, &lattice, mip0_size),
            px_per_step: PIXELS_AT_ZOOM_1 * f64::from(config.max_zoom) / lattice.longer_steps(),
            error_px: config.error_px,
        }
    }

    /// Whether eight bits may be fine enough.
    fn resolves(&self) -> bool {
        ROUNDING_QUANTA * self.scales.range / QUANTA * self.px_per_step <= self.error_px
    }
}

/// Judges every item of `drawing`. The same at any thread count.
pub(crate) fn judge(drawing: &Drawing, config: &BakeConfig, mip0_size: u32) -> Judgement {
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
        .map(|size| Candidate::new(drawing, config, mip0_size, size))
        .filter(Candidate::resolves)
        .collect();
    if candidates.is_empty() {
        let finding = Finding::Quantisation;
        return all(Verdict::unmeasured(Coverage::Curves, finding));
    }
    choose::choose(drawing, config, mip0_size, &candidates)
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

/// Whether every shape of `drawing` becomes curves, and there is one.
pub(crate) fn all_curves(drawing: &Drawing, verdicts: &[Verdict]) -> bool {
    let mut shapes = drawing
        .items
        .iter()
        .zip(verdicts)
        .filter(|(item, _)| matches!(item, Item::Shape(_)))
        .peekable();
    shapes.peek().is_some() && shapes.all(|(_, verdict)| verdict.coverage == Coverage::Curves)
}

/// Two to three digits are enough for a report, and pack well.
fn error_record(p99_px: f64, wrong_share: f64) -> FieldError {
    let short = |x: f64| f32::from_bits(to_f32(x).to_bits() & SHORT_FLOAT);
    FieldError {
        wrong_share: short(wrong_share),
        p99_px: short(p99_px),
    }
}
