//! The curve lattice: how fine the integers of curve records are.

use vtex_format::CurveLattice;

use crate::{
    coverage::{grid::Lattice, placed::Placed, scales::Scales},
    number::{count, floor_index, to_f32},
};

/// How far lowering may move a curve, and turning a flat curve into a line, in pixels at the
/// largest zoom.
const TOLERANCE_PX: f64 = 0.05;
/// Width of a unit in pixels at the largest zoom, unless records cannot be that fine. Rounding
/// moves a point by half a unit at most along each axis.
pub(crate) const UNIT_PX: f64 = 0.04;
/// Least units along a cell, so that rounding does not show when `max_zoom` is small either.
const MIN_UNITS_PER_CELL: usize = 1024;
/// Smallest tolerance in units: rounding alone costs as much.
const MIN_TOLERANCE_UNITS: f64 = 0.5;

/// The curve lattice for items on `lattice`; `None` when nothing becomes curves.
pub(crate) fn curve_lattice(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
) -> Option<CurveLattice> {
    if !placed.iter().any(Placed::is_curves) {
        return None;
    }
    // The margin of a record is at most one cell. No lookup looks beyond the cell itself.
    let margin_cells = (scales.distances.margin / lattice.cell_steps()).min(1.0);
    let finest = CurveLattice::new(to_f32(margin_cells))?;
    // Finer units than anyone can see cost bytes: the low bits of coordinates are noise, which does
    // not compress.
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

/// Tolerance of lowering and cutting in units: how far a quadratic may be from the cubic it
/// replaces, and a line from the quadratic it replaces. An f32, because the file holds it and
/// readers must cut with the same number. `longer_side_px` is the canvas' longer side at the
/// largest zoom.
pub(crate) fn flatness_units(
    lattice: &Lattice,
    curve_lattice: CurveLattice,
    longer_side_px: f64,
) -> f32 {
    let units_per_step = f64::from(curve_lattice.units_per_cell) / lattice.cell_steps();
    let units_per_px = units_per_step * lattice.longer_steps() / longer_side_px;
    to_f32((TOLERANCE_PX * units_per_px).max(MIN_TOLERANCE_UNITS))
}
