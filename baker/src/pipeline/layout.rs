//! The grid that a drawing is placed on, and what each item is to its cells.

use kurbo::Shape as _;

use super::fallback::patch_failures;
use crate::{
    config::BakeConfig,
    coverage::{
        cover::{Cover, cover},
        curves::CurveError,
        grid::Lattice,
        judge::judge,
        placed::{Placed, PlacedKind, place},
        scales::Scales,
        verdict::{Judgement, Verdict},
    },
    drawing::Drawing,
    raster::patch::PatchSettings,
};

/// Most segments into which the cells of a grid that is tried may cut the outlines. They take
/// 200 MiB.
const MAX_CUT_SEGMENTS: f64 = 2e6;

/// A drawing on its grid.
#[derive(Debug)]
pub(crate) struct Layout {
    /// The grid and the lattice of its texels.
    pub(crate) lattice: Lattice,
    /// Distances on it.
    pub(crate) scales: Scales,
    /// The items, in painter's order.
    pub(crate) placed: Vec<Placed>,
    /// Where each of them shows.
    pub(crate) covers: Vec<Cover>,
}

/// Judges the shapes and places the drawing on a grid. Shapes that are too complex for curves
/// become patches in `drawing`.
pub(crate) fn lay_out(drawing: &mut Drawing, config: &BakeConfig) -> Layout {
    let judgement = judge(drawing, config);
    let attempt = place_on_grid(drawing, &judgement, config);
    let Attempt {
        lattice,
        scales,
        mut placed,
        covers,
    } = attempt;
    let settings = PatchSettings::new(drawing.canvas_size, config);
    let covers = patch_failures(covers, drawing, &mut placed, &lattice, settings);
    Layout {
        lattice,
        scales,
        placed,
        covers,
    }
}

/// A drawing on a grid whose cells some shapes may be too complex for.
struct Attempt {
    lattice: Lattice,
    scales: Scales,
    placed: Vec<Placed>,
    covers: Vec<Result<Cover, CurveError>>,
}

impl Attempt {
    fn new(drawing: &Drawing, verdicts: &[Verdict], config: &BakeConfig, lattice: Lattice) -> Self {
        let scales = Scales::new(config);
        let placed = place(drawing, &lattice, verdicts);
        let covers = cover(&placed, &lattice, &scales);
        Self {
            lattice,
            scales,
            placed,
            covers,
        }
    }
}

/// Places the drawing on a grid. If all shapes are curves, it is the coarsest one whose cells have
/// room for the outlines, as far as [`MAX_CUT_SEGMENTS`] allows; with MSDFs the judge has decided
/// the size.
fn place_on_grid(drawing: &Drawing, judgement: &Judgement, config: &BakeConfig) -> Attempt {
    let canvas_size = drawing.canvas_size;
    let msdf_size = judgement.msdf_size;
    let on = |lattice| Attempt::new(drawing, &judgement.verdicts, config, lattice);
    if !judgement.all_curves(&drawing.items) {
        return on(Lattice::new(canvas_size, msdf_size));
    }
    let mut attempt = on(Lattice::for_curves(canvas_size, msdf_size));
    // An outline that is too much for one cell may fit into smaller ones.
    while attempt.covers.iter().any(Result::is_err) {
        let halved = attempt.lattice.halved(canvas_size);
        let Some(halved) =
            halved.filter(|halved| cut_segments(&attempt.placed, halved) <= MAX_CUT_SEGMENTS)
        else {
            break;
        };
        attempt = on(halved);
    }
    attempt
}

/// About how many segments the cells of `lattice` would cut the outlines into. They are placed on
/// another lattice, so lengths are taken relative to the canvas.
fn cut_segments(placed: &[Placed], lattice: &Lattice) -> f64 {
    let shapes = placed.iter().filter(|item| item.kind != PlacedKind::Image);
    let segments = shapes.flat_map(|item| item.outline.segments());
    let extent: f64 = segments
        .map(|segment| {
            let bounds = segment.bounding_box();
            (bounds.width() + bounds.height()) / lattice.longer_steps()
        })
        .sum();
    extent * f64::from(lattice.grid.size_cells[0].max(lattice.grid.size_cells[1]))
}
