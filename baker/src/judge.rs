//! Which kind of coverage a shape gets: a distance field where it is good enough, else curves.

use crate::{
    config::{BakeConfig, Mode},
    drawing::{Drawing, Item},
    grid::Lattice,
    scales::Scales,
};

mod measure;

pub(crate) use measure::Measured;

/// Pixels of the canvas' longer side at zoom 1.
pub(crate) const PIXELS_AT_ZOOM_1: f64 = 512.0;
/// Share of probes beside the edge that a distance field may put on the wrong side.
const WRONG_SHARE_BOUND: f64 = 1e-3;
/// Rounding a stored distance moves an edge by at most half of this share of the range.
const QUANTA: f64 = 255.0;

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
    /// Why.
    pub(crate) reason: Reason,
}

/// What a [`Verdict`] rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reason {
    /// The mode leaves no choice.
    Forced,
    /// Eight bits of distance are too coarse for the wanted zoom.
    Quantisation,
    /// A distance field was made and measured.
    Measured(Measured),
    /// The outline fits no curve record.
    TooComplex,
}

impl Verdict {
    /// A verdict that the mode gives.
    pub(crate) fn forced(coverage: Coverage) -> Self {
        Self {
            coverage,
            reason: Reason::Forced,
        }
    }

    /// As recorded in the file.
    pub(crate) fn text(self) -> String {
        let kind = match self.coverage {
            Coverage::Msdf => "msdf",
            Coverage::Curves => "curves",
        };
        match self.reason {
            Reason::Forced => kind.to_owned(),
            Reason::Quantisation => format!("{kind}: beyond quantisation"),
            Reason::TooComplex => format!("{kind}: too complex for curves"),
            Reason::Measured(Measured { p99_px, wrong }) => {
                format!(
                    "{kind}: distance field off by {p99_px:.3} px, {:.2}% wrong",
                    100.0 * wrong
                )
            }
        }
    }
}

/// Judges every item of `drawing`; what it says of patches has no meaning.
pub(crate) fn judge(drawing: &Drawing, config: &BakeConfig, mip0_size: u32) -> Vec<Verdict> {
    let all = |verdict| vec![verdict; drawing.items.len()];
    match config.mode {
        Mode::Curves => return all(Verdict::forced(Coverage::Curves)),
        Mode::Msdf | Mode::Raster => return all(Verdict::forced(Coverage::Msdf)),
        Mode::Auto => {}
    }
    // Outlines around shapes and layers of shapes that touch are what distance fields are for.
    if config.outline_texels.is_some() || config.merge {
        return all(Verdict::forced(Coverage::Msdf));
    }
    let lattice = Lattice::new(drawing.canvas_size, config.msdf_size);
    let scales = Scales::new(config, &lattice, mip0_size);
    let px_per_step = PIXELS_AT_ZOOM_1 * f64::from(config.max_zoom) / lattice.longer_steps();
    if 0.5 * scales.range / QUANTA * px_per_step > config.error_px {
        return all(Verdict {
            coverage: Coverage::Curves,
            reason: Reason::Quantisation,
        });
    }
    measure::measure(drawing, &lattice, scales, px_per_step, config.error_px)
        .into_iter()
        .zip(&drawing.items)
        .map(|(measured, item)| verdict(measured, item, config.error_px))
        .collect()
}

fn verdict(measured: Measured, item: &Item, error_px: f64) -> Verdict {
    let good = measured.p99_px <= error_px && measured.wrong <= WRONG_SHARE_BOUND;
    let coverage = if good || matches!(item, Item::Patch(_)) {
        Coverage::Msdf
    } else {
        Coverage::Curves
    };
    Verdict {
        coverage,
        reason: Reason::Measured(measured),
    }
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
