//! Choosing the size of the MSDF lattice, and with it the kind of each shape.
//!
//! Cost decides, within the bound on the error. Bytes and time count as shares of what the drawing
//! would cost with curves alone, so a small and a large drawing are judged alike.

use rayon::prelude::*;
use vtex_format::{Finding, MsdfError};

use super::{
    candidate::Candidate,
    cost::{Cost, Extent, ground},
    measure::{Measured, measure},
};
use crate::{
    config::BakeConfig,
    coverage::{
        grid::Lattice,
        placed::place_prepared,
        scales::Scales,
        verdict::{Coverage, Judgement, Verdict},
    },
    drawing::{Drawing, Item},
    geometry::prepare::{Note, Prepared, clean, prepare},
    number::to_f32,
};

/// Mean width of a hairline in steps, at most. Both edges then lie between the same texels, and no
/// MSDF can hold both. Such shapes are not measured. Measured: of 51 shapes of the Tiger that fail
/// at 64 texels for each shape, 39 are such strokes.
const HAIRLINE_STEPS: f64 = 1.0;

/// MSDFs must bring the cost below this share of what curves alone cost. Estimates are only about
/// that precise, and a file with both kinds needs the shader code of both.
const WORTHWHILE: f64 = 0.95;

/// Bits of a float that reports keep: 7 of the mantissa, two to three digits. Zeros compress well.
const SHORT_FLOAT: u32 = 0xFFFF_0000;

/// A shape before its kind is known.
struct Subject {
    prepared: Prepared,
    /// Extent of the prepared outline, which an MSDF would show.
    extent: Extent,
    /// Extent of the outline as drawn, which curves would show.
    drawn: Extent,
}

/// The result of judging a shape at one size.
#[derive(Clone, Copy, Debug)]
struct Trial {
    finding: Finding,
    size_texels: u32,
    measured: Option<Measured>,
}

/// One size with its results: a trial for each shape, and whether it becomes an MSDF.
struct Choice {
    size: u32,
    trials: Vec<Option<Trial>>,
    msdfs: Vec<bool>,
    cost: f64,
}

/// Judges every shape at the sizes that may pay and takes what costs least.
///
/// Measuring is slow, estimating is fast. The least that a size can cost is known before anything
/// is measured: every shape is then the kind that is cheaper. Sizes are measured from the most
/// promising on, until the next could not beat the best so far. The first is always measured, for
/// the report.
pub(super) fn choose(
    drawing: &Drawing,
    config: &BakeConfig,
    candidates: &[Candidate],
) -> Judgement {
    let choosing = Choosing::new(drawing, config);
    let mut promises: Vec<(f64, &Candidate)> = candidates
        .iter()
        .map(|candidate| (choosing.least_cost(candidate), candidate))
        .collect();
    promises.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The cost of curves relative to itself is 2: a share of 1 in bytes and of 1 in time.
    let curves = WORTHWHILE * choosing.whole.relative_to(choosing.whole);
    let mut best: Option<Choice> = None;
    for (promise, candidate) in promises {
        if best
            .as_ref()
            .is_some_and(|best| promise >= best.cost.min(curves))
        {
            break;
        }
        let choice = choosing.try_candidate(candidate);
        if best.as_ref().is_none_or(|best| choice.cost < best.cost) {
            best = Some(choice);
        }
    }
    let Some(mut best) = best else {
        return Judgement {
            verdicts: Vec::new(),
            msdf_size: config.msdf_size,
        };
    };
    // The trials stay for the report even if no MSDF is used.
    if best.cost >= curves {
        best.msdfs.fill(false);
    }
    best.into_judgement(config.msdf_size)
}

impl Choice {
    /// `msdf_size` is the size of the lattice if no shape becomes an MSDF.
    fn into_judgement(self, msdf_size: u32) -> Judgement {
        let has_msdfs = self.msdfs.contains(&true);
        let verdicts = self.trials.into_iter().zip(self.msdfs);
        Judgement {
            verdicts: verdicts.map(|(trial, msdf)| verdict(trial, msdf)).collect(),
            msdf_size: if has_msdfs { self.size } else { msdf_size },
        }
    }
}

/// One element for each item; only shapes have a subject.
fn subjects(drawing: &Drawing, longer_side_px: f64) -> Vec<Option<Subject>> {
    let longer = drawing.longer_side();
    let subject = |item: &Item| match item {
        Item::Shape(shape) => {
            let prepared = prepare(shape, longer);
            let drawn = clean(&shape.outline, longer);
            Some(Subject {
                extent: Extent::new(&prepared.outline, drawing.canvas_size, longer_side_px),
                drawn: Extent::new(&drawn, drawing.canvas_size, longer_side_px),
                prepared,
            })
        }
        Item::Image(_) | Item::Clip(_) => None,
    };
    drawing.items.par_iter().map(subject).collect()
}

/// What all sizes have in common.
struct Choosing {
    subjects: Vec<Option<Subject>>,
    mip0_size: u32,
    /// Cost of the drawing with nothing but curves, on the grid it would then have.
    whole: Cost,
}

impl Choosing {
    fn new(drawing: &Drawing, config: &BakeConfig) -> Self {
        let subjects = subjects(drawing, config.longer_side_px());
        let mip0_size = config.mip0_size;
        let lattice = Lattice::for_curves(drawing.canvas_size, config.msdf_size);
        let margin = Scales::new(config).distances.margin;
        let whole = subjects
            .iter()
            .flatten()
            .map(|subject| subject.drawn.as_curves(&lattice, margin))
            .fold(ground(&lattice, mip0_size), Cost::plus);
        Self {
            subjects,
            mip0_size,
            whole,
        }
    }

    /// The least cost on the candidate's lattice: as if no MSDF could fail.
    fn least_cost(&self, candidate: &Candidate) -> f64 {
        self.cost(candidate, &vec![true; self.subjects.len()])
    }

    /// The drawing's cost on the candidate's lattice, relative to `whole`. Shapes with a `true` may
    /// become MSDFs; they do if that is cheaper.
    fn cost(&self, candidate: &Candidate, may_be_msdfs: &[bool]) -> f64 {
        let cost_of = |(subject, &may_be_msdf): (&Option<Subject>, &bool)| {
            let subject = subject.as_ref()?;
            let [msdf, curves] = subject.costs(candidate);
            // A shape takes the cheaper kind, so the sum is a lower bound while nothing is known to
            // fail.
            let is_msdf = may_be_msdf && subject.pays_as_msdf(candidate, self.whole);
            Some(if is_msdf { msdf } else { curves })
        };
        self.subjects
            .iter()
            .zip(may_be_msdfs)
            .filter_map(cost_of)
            .fold(ground(&candidate.lattice, self.mip0_size), Cost::plus)
            .relative_to(self.whole)
    }

    /// Measures every shape on the candidate's lattice.
    fn try_candidate(&self, candidate: &Candidate) -> Choice {
        let trials: Vec<Option<Trial>> = self
            .subjects
            .par_iter()
            .map(|subject| Some(subject.as_ref()?.judge_at(candidate)))
            .collect();
        let sound = |trial: &Option<Trial>| trial.is_some_and(|t| t.finding == Finding::None);
        let within: Vec<bool> = trials.iter().map(sound).collect();
        let pays = |subject: &Option<Subject>| {
            let subject = subject.as_ref();
            subject.is_some_and(|subject| subject.pays_as_msdf(candidate, self.whole))
        };
        Choice {
            size: candidate.size,
            cost: self.cost(candidate, &within),
            msdfs: self
                .subjects
                .iter()
                .zip(&within)
                .map(|(subject, &within)| within && pays(subject))
                .collect(),
            trials,
        }
    }
}

impl Subject {
    /// The shape's cost as an MSDF, and as curves.
    fn costs(&self, candidate: &Candidate) -> [Cost; 2] {
        let margin = candidate.scales.distances.margin;
        [
            self.extent.as_msdf(candidate),
            self.drawn.as_curves(&candidate.lattice, margin),
        ]
    }

    /// Whether an MSDF costs less than curves. A shape that does not show costs nothing either way
    /// and becomes curves.
    fn pays_as_msdf(&self, candidate: &Candidate, whole: Cost) -> bool {
        let [msdf, curves] = self.costs(candidate).map(|cost| cost.relative_to(whole));
        msdf < curves
    }

    fn judge_at(&self, candidate: &Candidate) -> Trial {
        let placed = place_prepared(&self.prepared, &candidate.lattice);
        let trial = |finding, measured| Trial {
            finding,
            size_texels: placed.size_texels(),
            measured,
        };
        // The transform scales both axes alike, because cells are square in user units.
        let units_per_step = candidate.lattice.lattice_from_canvas.as_coeffs()[0].recip();
        // Without contours that are free of overlaps distances have no sign. No measurement is
        // needed.
        if self.prepared.note == Note::Failed {
            return trial(Finding::Overlaps, None);
        }
        if self.extent.width <= HAIRLINE_STEPS * units_per_step {
            return trial(Finding::Hairline, None);
        }
        let measured = measure(&placed, candidate);
        let finding = if measured.within(candidate.error_px) {
            Finding::None
        } else {
            measured.cause
        };
        trial(finding, Some(measured))
    }
}

fn verdict(trial: Option<Trial>, msdf: bool) -> Verdict {
    let Some(trial) = trial else {
        return Verdict::forced(Coverage::Msdf);
    };
    Verdict {
        coverage: if msdf {
            Coverage::Msdf
        } else {
            Coverage::Curves
        },
        finding: match trial.finding {
            // The MSDF would have been good enough, so it was the cost.
            Finding::None if !msdf => Finding::Cost,
            finding => finding,
        },
        size_texels: trial.size_texels,
        error: trial
            .measured
            .map(|measured| error_record(measured.p99_px, measured.wrong)),
    }
}

/// The measured error as reports keep it.
fn error_record(p99_px: f64, wrong_share: f64) -> MsdfError {
    let short = |x: f64| f32::from_bits(to_f32(x).to_bits() & SHORT_FLOAT);
    MsdfError {
        wrong_share: short(wrong_share),
        p99_px: short(p99_px),
    }
}
