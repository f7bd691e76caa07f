//! The lattice of curve records: how fine their integers are on the cells' lattice.

use vtex_format::CurveLattice;

use crate::{
    coverage::{grid::Lattice, placed::Placed, scales::Scales},
    number::{count, floor_index, to_f32},
};

/// How far lowering may move a curve, and making lines of flat ones, in pixels at maximum zoom.
const TOLERANCE_PX: f64 = 0.05;
/// Width of a unit of curve records in pixels at maximum zoom, unless records cannot be that fine.
/// A point is off by half a unit.
pub(crate) const UNIT_PX: f64 = 0.04;
/// Units along a cell at least, so that rounding never shows at low zooms either.
const MIN_UNITS_PER_CELL: usize = 1024;
/// No tolerance is smaller: a unit is what rounding costs.
const MIN_TOLERANCE_UNITS: f64 = 0.5;

/// The lattice of curve records on `lattice`, or `None` where nothing needs one.
pub(crate) fn curve_lattice(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
) -> Option<CurveLattice> {
    if !placed.iter().any(Placed::is_curves) {
        return None;
    }
    // Wider ramps than a cell are cut off; mips serve such footprints unless they are tiny.
    let margin_cells = (scales.distances.margin / lattice.cell_steps()).min(1.0);
    let finest = CurveLattice::new(to_f32(margin_cells))?;
    // Finer than what anyone sees costs bytes: the low bits of coordinates are noise.
    let cells = lattice.longer_steps() / lattice.cell_steps();
    let wanted = scales.longer_side_px / (UNIT_PX * cells);
    if wanted >= f64::from(finest.units_per_cell) {
        return Some(finest);
    }
    let units_per_cell = floor_index(wanted.ceil()).max(MIN_UNITS_PER_CELL);
    let margin_units = floor_index((margin_cells * count(units_per_cell)).ceil());
    Some(CurveLattice {
        units_per_cell: u32::try_from(units_per_cell).ok()?,
        margin_units: u32::try_from(margin_units).ok()?,
    })
}

/// Within how many units of its chord a quadratic may stay to become a line, and a quadratic of the
/// cubic it stands for. A number that a file holds exactly. `longer_side_px` is the canvas' longer
/// side at the largest zoom.
pub(crate) fn flatness_units(
    lattice: &Lattice,
    curve_lattice: CurveLattice,
    longer_side_px: f64,
) -> f32 {
    let units_per_step = f64::from(curve_lattice.units_per_cell) / lattice.cell_steps();
    let units_per_px = units_per_step * lattice.longer_steps() / longer_side_px;
    to_f32((TOLERANCE_PX * units_per_px).max(MIN_TOLERANCE_UNITS))
}
