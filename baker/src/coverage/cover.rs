//! What each item is to the cells, by its kind of coverage.

use kurbo::Affine;
use rayon::prelude::*;
use vtex_format::{CurveLattice, SourceOutline, Warning, WarningCode, cut::CellCurves};

use crate::{
    cells::sources::source_outline,
    coverage::{
        classify::{ShapeCells, classify},
        curves::{
            CurveError,
            lower::LoweredOutline,
            record::encode_record,
            split::split,
            sweep::{CutParams, cut_to_cells},
        },
        grid::Lattice,
        judge::{Coverage, PIXELS_AT_ZOOM_1, Verdict},
        placed::{Placed, PlacedKind, place_item},
        scales::Scales,
    },
    drawing::{Drawing, Item, Patch, to_f32},
    geometry::floor_index,
    raster::patch::{self, PatchSettings},
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

/// Segments of one shape in one cell; more would leave no room in the cell's list.
const MAX_CELL_SEGMENTS: usize = vtex_format::MAX_LIST_ITEMS as usize * 3 / 4;

/// An item against the grid.
#[derive(Debug, Default)]
pub(crate) struct Cover {
    /// Where it is listed; without edges for tiles unless it has a distance field.
    pub(crate) cells: ShapeCells,
    /// Its outline in the cells that list it, cell by cell, if it is curves.
    pub(crate) curves: Vec<CellCurves>,
    /// The whole outline as the file stores it, if it is curves and the lattice holds it.
    pub(crate) source: Option<SourceOutline>,
    /// Where each listed cell's part of `curves` begins; empty where each has one.
    firsts: Vec<u32>,
}

impl Cover {
    /// Of what covers the whole canvas.
    fn everywhere(lattice: &Lattice) -> Self {
        let count = u32::try_from(lattice.cell_count()).unwrap_or(u32::MAX);
        let mut cover = Self::default();
        cover.cells.full = (0..count).collect();
        cover
    }

    /// Its outline in `cell`: strips that add up to it, most often one. Empty unless it is curves.
    pub(crate) fn curves_in(&self, cell: u32) -> &[CellCurves] {
        let Ok(index) = self.cells.listed.binary_search(&cell) else {
            return &[];
        };
        let first_of = |index: usize| match self.firsts.get(index) {
            Some(&first) => first as usize,
            None if self.firsts.is_empty() => index,
            None => self.curves.len(),
        };
        let range = first_of(index)..first_of(index + 1);
        self.curves.get(range).unwrap_or(&[])
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

/// Covers every item; an error where a shape cannot be curves.
pub(crate) fn cover(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
    max_zoom: f32,
) -> Vec<Result<Cover, CurveError>> {
    let cutter = curve_lattice(placed, lattice, scales, max_zoom)
        .map(|curve_lattice| Cutter::new(lattice, curve_lattice, max_zoom));
    let cover_one = |placed: &Placed| {
        if placed.kind == PlacedKind::Patch {
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

/// Puts patches in the place of shapes that cannot be curves.
pub(crate) fn patch_failures(
    covers: Vec<Result<Cover, CurveError>>,
    drawing: &mut Drawing,
    placed: &mut [Placed],
    lattice: &Lattice,
    settings: PatchSettings,
) -> Vec<Cover> {
    let failures = covers.iter().filter(|cover| cover.is_err()).count();
    #[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
    let share = 1.0 / failures.max(1) as f64;
    let longer = drawing.canvas_size[0].max(drawing.canvas_size[1]);
    let items = drawing.items.iter_mut().zip(placed);
    let mut resolved = Vec::with_capacity(covers.len());
    for (cover, (item, placed)) in covers.into_iter().zip(items) {
        resolved.push(cover.unwrap_or_else(|_| {
            if matches!(item, Item::Clip(_)) {
                drawing.warnings.push(clip_warning());
                return Cover::everywhere(lattice);
            }
            // A shape of which nothing shows is listed nowhere.
            if let Some(patch) = patch::of_shape(item, settings, share) {
                drawing
                    .warnings
                    .push(failure_warning(&patch, drawing.canvas_size));
                *item = Item::Patch(patch);
                *placed = place_item(item, lattice, longer, Verdict::forced(Coverage::Msdf));
            }
            Cover::default()
        }));
    }
    resolved
}

fn clip_warning() -> Warning {
    Warning {
        code: WarningCode::PathFallback,
        feature: "clipPath".into(),
        element: String::new(),
        message: "an outline to clip to is too complex for curves; nothing is clipped to it".into(),
        area: 0.0,
    }
}

fn failure_warning(patch: &Patch, canvas_size: [f64; 2]) -> Warning {
    let [width, height] = patch.image.size;
    Warning {
        code: WarningCode::PathFallback,
        feature: patch.feature.clone(),
        element: patch.element.clone(),
        message: format!(
            "this outline is too complex for curves; it is stored as a raster of {width} x {height} \
             texels"
        ),
        area: patch.area(canvas_size),
    }
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
        let source = source_outline(&lowered, placed.rule);
        let mut cells = ShapeCells::default();
        for (cell, winding) in shape.covered {
            if placed.rule.fills(winding) {
                cells.full.push(cell);
            }
        }
        let mut curves = Vec::with_capacity(shape.edges.len());
        let mut firsts = Vec::new();
        // Strips of a cell are not what the reader would cut.
        let mut whole = true;
        let size = f64::from(self.params.lattice.box_units());
        for (cell, cell_curves) in shape.edges {
            firsts.push(u32::try_from(curves.len()).map_err(|_| CurveError::Overflow)?);
            let segments = cell_curves.segments.len();
            let parts = match encode_record(&[&cell_curves], placed.rule) {
                Ok(_) => vec![cell_curves],
                Err(_) => {
                    whole = false;
                    split(cell_curves, placed.rule, size)?
                }
            };
            // A list has room for one such shape.
            if segments > MAX_CELL_SEGMENTS {
                return Err(CurveError::Overflow);
            }
            for part in &parts {
                encode_record(&[part], placed.rule)?;
            }
            cells.listed.push(cell);
            curves.extend(parts);
        }
        let source = source.filter(|_| whole);
        if curves.len() == cells.listed.len() {
            firsts = Vec::new();
        }
        Ok(Cover {
            cells,
            curves,
            source,
            firsts,
        })
    }
}

impl Placed {
    /// Whether it is to be curve records.
    pub(crate) fn is_curves(&self) -> bool {
        match &self.kind {
            PlacedKind::Shape { verdict, .. } => verdict.coverage == Coverage::Curves,
            PlacedKind::Clip => true,
            PlacedKind::Patch => false,
        }
    }
}
