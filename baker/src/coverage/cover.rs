//! What each item is to the cells of the grid, by its kind of coverage.

use kurbo::Affine;
use rayon::prelude::*;
use vtex_format::{CurveLattice, StoredOutline, cut::CellCurves};

use crate::{
    coverage::{
        classify::{ShapeCells, classify},
        curve_lattice::{curve_lattice, flatness_units},
        curves::{
            CurveError,
            lower::LoweredOutline,
            record::encode_record,
            split::split,
            stored_outline::stored_outline,
            sweep::{CutParams, cut_to_cells},
        },
        grid::Lattice,
        placed::{Placed, PlacedKind},
        scales::Scales,
    },
    drawing::FillRule,
};

/// Segments of one shape in one cell. A shape with more would leave no room for others in the
/// cell's list, which evaluators bound.
const MAX_CELL_SEGMENTS: usize = vtex_format::MAX_LIST_COMMANDS as usize * 3 / 4;

/// Where an item shows on the grid.
#[derive(Debug, Default)]
pub(crate) struct Cover {
    /// The cells that list it. It has edges for tiles only if it is an MSDF.
    pub(crate) cells: ShapeCells,
    /// If it is curves, its outline in each cell that lists it, cell by cell.
    pub(crate) curves: Vec<CellCurves>,
    /// If it is curves, the whole outline as the file stores it; `None` where a reader could not
    /// cut it to the same records.
    pub(crate) stored: Option<StoredOutline>,
    /// Index into `curves` of each listed cell's first part; empty when each cell has exactly one.
    firsts: Vec<u32>,
}

impl Cover {
    /// The cover of what fills the whole canvas.
    pub(crate) fn everywhere(lattice: &Lattice) -> Self {
        let count = u32::try_from(lattice.cell_count()).unwrap_or(u32::MAX);
        let mut cover = Self::default();
        cover.cells.full = (0..count).collect();
        cover
    }

    /// Its outline in `cell`: one part, or strips that add up to it. Empty unless it is curves.
    pub(crate) fn curves_in(&self, cell: u32) -> &[CellCurves] {
        let Ok(index) = self.cells.listed.binary_search(&cell) else {
            return &[];
        };
        // Without `firsts` every cell has one part, so the index of the cell is that of the part.
        let first_of = |index: usize| match self.firsts.get(index) {
            Some(&first) => first as usize,
            None if self.firsts.is_empty() => index,
            None => self.curves.len(),
        };
        let range = first_of(index)..first_of(index + 1);
        self.curves.get(range).unwrap_or(&[])
    }
}

/// The cover of every item, or why a shape cannot be curves on this grid.
pub(crate) fn cover(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
) -> Vec<Result<Cover, CurveError>> {
    // There is no cutter if nothing is curves.
    let cutter = curve_lattice(placed, lattice, scales)
        .map(|curve_lattice| Cutter::new(lattice, curve_lattice, scales));
    let cover_one = |placed: &Placed| {
        if placed.kind == PlacedKind::Image {
            return Ok(Cover::default());
        }
        if let (true, Some(cutter)) = (placed.is_curves(), &cutter) {
            return cutter.cut(placed);
        }
        Ok(Cover {
            cells: classify(placed, lattice, scales.distances),
            ..Cover::default()
        })
    };
    placed.par_iter().map(cover_one).collect()
}

/// Cuts outlines to cells.
struct Cutter {
    params: CutParams,
    units_from_steps: Affine,
}

impl Cutter {
    fn new(lattice: &Lattice, curve_lattice: CurveLattice, scales: &Scales) -> Self {
        let units_per_step = f64::from(curve_lattice.units_per_cell) / lattice.cell_steps();
        Self {
            params: CutParams {
                size_cells: lattice.grid.size_cells,
                lattice: curve_lattice,
                flatness_units: f64::from(flatness_units(
                    lattice,
                    curve_lattice,
                    scales.longer_side_px,
                )),
            },
            units_from_steps: Affine::scale(units_per_step),
        }
    }

    fn cut(&self, placed: &Placed) -> Result<Cover, CurveError> {
        // Both lattices have their origin at the corner of cell (0, 0).
        let outline = self.units_from_steps * &placed.outline;
        let lowered = LoweredOutline::new(&outline, self.params.flatness_units)?;
        let shape = cut_to_cells(&lowered, &self.params);
        let stored = stored_outline(&lowered, placed.rule);
        let mut cells = ShapeCells::default();
        // A cell without an edge in its box has one winding: inside or not.
        let filled = shape.covered.into_iter();
        let filled = filled.filter(|&(_, winding)| placed.rule.fills(winding));
        cells.full = filled.map(|(cell, _)| cell).collect();
        let mut curves = Vec::with_capacity(shape.edges.len());
        let mut firsts = Vec::new();
        // A reader cuts the stored outline to whole cells, never to strips: with a strip the file
        // must hold the records themselves.
        let mut whole = true;
        for (cell, cell_curves) in shape.edges {
            firsts.push(u32::try_from(curves.len()).map_err(|_| CurveError::Overflow)?);
            cells.listed.push(cell);
            // Strips hold all segments of the cell again, so they do not help here.
            if cell_curves.segments.len() > MAX_CELL_SEGMENTS {
                return Err(CurveError::Overflow);
            }
            if encode_record(&[&cell_curves], placed.rule).is_ok() {
                curves.push(cell_curves);
            } else {
                whole = false;
                curves.extend(self.strips(cell_curves, placed.rule)?);
            }
        }
        let stored = stored.filter(|_| whole);
        // The usual case needs no table.
        if curves.len() == cells.listed.len() {
            firsts = Vec::new();
        }
        Ok(Cover {
            cells,
            curves,
            stored,
            firsts,
        })
    }
    /// The parts of a cell that is too much for one record. Each fits a record of its own.
    fn strips(&self, cell: CellCurves, rule: FillRule) -> Result<Vec<CellCurves>, CurveError> {
        let size = f64::from(self.params.lattice.box_units());
        let parts = split(cell, rule, size)?;
        for part in &parts {
            encode_record(&[part], rule)?;
        }
        Ok(parts)
    }
}
