//! What each item is to the cells, by its kind of coverage.

use kurbo::Affine;
use rayon::prelude::*;
use vtex_format::CurveLattice;

use crate::{
    classify::{ShapeCells, classify},
    curves::{
        CurveError,
        lower::LoweredOutline,
        record::encode_record,
        sweep::{CellCurves, CutParams, cut_to_cells},
    },
    drawing::{Drawing, to_f32},
    geometry::floor_index,
    grid::Lattice,
    judge::{Coverage, PIXELS_AT_ZOOM_1, Reason, Verdict},
    placed::{Placed, PlacedKind, place_item},
    scales::Scales,
};

/// How far lowering may move a curve, and making lines of flat ones, in pixels at maximum zoom.
const TOLERANCE_PX: f64 = 0.05;
/// Width of a unit of curve records in pixels at maximum zoom, unless records cannot be that fine.
/// A point is off by half a unit.
const UNIT_PX: f64 = 0.04;
/// Units along a cell at least, so that rounding never shows at low zooms either.
const MIN_UNITS_PER_CELL: usize = 1024;
/// No tolerance is smaller: a unit is what rounding costs.
const MIN_TOLERANCE_UNITS: f64 = 0.5;

/// An item against the grid.
#[derive(Debug, Default)]
pub(crate) struct Cover {
    /// Where it is listed; without edges for tiles unless it has a distance field.
    pub(crate) cells: ShapeCells,
    /// Its outline in each cell that lists it, if it is curves.
    pub(crate) curves: Vec<CellCurves>,
}

impl Cover {
    /// Its outline in `cell`.
    pub(crate) fn curves_in(&self, cell: u32) -> Option<&CellCurves> {
        let index = self.cells.listed.binary_search(&cell).ok()?;
        self.curves.get(index)
    }
}

/// Within how many units of its chord a quadratic may stay to become a line, and a quadratic of the
/// cubic it stands for. A number that a file holds exactly.
pub(crate) fn flatness_units(lattice: &Lattice, curve_lattice: CurveLattice, max_zoom: f32) -> f32 {
    let units_per_step = f64::from(curve_lattice.units_per_cell) / lattice.cell_steps();
    let units_per_px =
        units_per_step * lattice.longer_steps() / (PIXELS_AT_ZOOM_1 * f64::from(max_zoom));
    to_f32((TOLERANCE_PX * units_per_px).max(MIN_TOLERANCE_UNITS))
}

/// The lattice of curve records on `lattice`, or `None` where nothing needs one.
pub(crate) fn curve_lattice(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
    max_zoom: f32,
) -> Option<CurveLattice> {
    if !placed.iter().any(Placed::is_curves) {
        return None;
    }
    // Wider ramps than a cell are cut off; mips serve such footprints unless they are tiny.
    let margin_cells = (scales.distances.margin / lattice.cell_steps()).min(1.0);
    let finest = CurveLattice::new(to_f32(margin_cells))?;
    // Finer than what anyone sees costs bytes: the low bits of coordinates are noise.
    let cells = lattice.longer_steps() / lattice.cell_steps();
    let wanted = PIXELS_AT_ZOOM_1 * f64::from(max_zoom) / (UNIT_PX * cells);
    if wanted >= f64::from(finest.units_per_cell) {
        return Some(finest);
    }
    let units_per_cell = floor_index(wanted.ceil()).max(MIN_UNITS_PER_CELL);
    #[expect(clippy::cast_precision_loss, reason = "a few thousand")]
    let margin_units = floor_index((margin_cells * units_per_cell as f64).ceil());
    Some(CurveLattice {
        units_per_cell: u32::try_from(units_per_cell).ok()?,
        margin_units: u32::try_from(margin_units).ok()?,
    })
}

/// Covers every item; what cannot be curves becomes a distance field in `placed`.
pub(crate) fn cover(
    placed: &mut [Placed],
    drawing: &Drawing,
    lattice: &Lattice,
    scales: &Scales,
    max_zoom: f32,
) -> Vec<Cover> {
    let cutter = curve_lattice(placed, lattice, scales, max_zoom)
        .map(|curve_lattice| Cutter::new(lattice, curve_lattice, max_zoom));
    let longer = drawing.canvas_size[0].max(drawing.canvas_size[1]);
    let cover_one = |(placed, item)| {
        let placed: &mut Placed = placed;
        if !placed.is_shape() {
            return Cover::default();
        }
        if let (true, Some(cutter)) = (placed.is_curves(), &cutter) {
            if let Ok(cover) = cutter.cut(placed) {
                return cover;
            }
            let verdict = Verdict {
                coverage: Coverage::Msdf,
                reason: Reason::TooComplex,
            };
            *placed = place_item(item, lattice, longer, verdict);
        }
        Cover {
            cells: classify(placed, lattice, scales.distances),
            curves: Vec::new(),
        }
    };
    placed
        .par_iter_mut()
        .zip(&drawing.items)
        .map(cover_one)
        .collect()
}

/// Cuts outlines to cells.
struct Cutter {
    params: CutParams,
    units_from_steps: Affine,
}

impl Cutter {
    fn new(lattice: &Lattice, curve_lattice: CurveLattice, max_zoom: f32) -> Self {
        let units_per_step = f64::from(curve_lattice.units_per_cell) / lattice.cell_steps();
        Self {
            params: CutParams {
                size_cells: lattice.grid.size_cells,
                lattice: curve_lattice,
                flatness_units: f64::from(flatness_units(lattice, curve_lattice, max_zoom)),
            },
            units_from_steps: Affine::scale(units_per_step),
        }
    }

    fn cut(&self, placed: &Placed) -> Result<Cover, CurveError> {
        let outline = self.units_from_steps * &placed.outline;
        let lowered = LoweredOutline::new(&outline, self.params.flatness_units)?;
        let shape = cut_to_cells(&lowered, &self.params);
        let mut cells = ShapeCells::default();
        for (cell, winding) in shape.covered {
            if placed.rule.fills(winding) {
                cells.full.push(cell);
            }
        }
        let mut curves = Vec::with_capacity(shape.edges.len());
        for (cell, cell_curves) in shape.edges {
            encode_record(&[&cell_curves], placed.rule)?;
            cells.listed.push(cell);
            curves.push(cell_curves);
        }
        Ok(Cover { cells, curves })
    }
}

impl Placed {
    /// Whether it is to be curve records.
    pub(crate) fn is_curves(&self) -> bool {
        matches!(self.kind, PlacedKind::Shape { verdict, .. } if verdict.coverage == Coverage::Curves)
    }
}
