//! The grid of cells and the lattice of MSDF texels: their sizes, and how the canvas lies on them.

use kurbo::{Affine, Rect};
use vtex_format::{Grid, MAX_TEXELS_PER_CELL};

use crate::number::{self, to_f32};

/// Texels along a cell, unless the grid would then leave [`MIN_CELLS`]..=[`MAX_CELLS`]. Small cells
/// mean short lists but many tiles. Measured on the Tiger at 1024 texels for 4, 6 and 8: 970, 905
/// and 889 KiB stored, 4.1, 4.3 and 4.8 MiB raw, 0.86, 1.10 and 1.33 entries for each lookup.
const TEXELS_PER_CELL: u32 = 6;
/// Cells along the longer side of the smallest grid.
const MIN_CELLS: u32 = 16;
/// Cells along the longer side of the largest grid: 1 MiB of cell words when square.
const MAX_CELLS: u32 = 512;
/// Cells along the longer side of the grid when all shapes are curves. Few, because readers divide
/// cells again when they load a file. Measured on the Tiger for 48, 64, 96 and 128: 480, 523, 621
/// and 716 KiB of records, 4.6, 4.1, 3.6 and 3.3 entries in a list.
const CURVE_CELLS: u32 = 64;
/// Where the canvas' corner lies in the first cell. Drawings like round coordinates. An edge on a
/// line of the grid would belong to the cells on both sides; with these fractions, which are far
/// from any simple ratio, such an edge hardly ever lies on one.
const LATTICE_OFFSET: [f32; 2] = [0.381_966, 0.276_393_2];

/// The MSDF lattice: its points are the places of stored texels. Its unit is one step, its origin
/// is the corner of cell (0, 0), and a cell is `texels_per_cell` steps wide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    /// The grid as the file stores it.
    pub(crate) grid: Grid,
    /// Canvas space to lattice.
    pub(crate) lattice_from_canvas: Affine,
    /// The canvas on the lattice.
    pub(crate) canvas: Rect,
}

impl Lattice {
    /// The lattice with `msdf_size` texels along the canvas' longer side. Cells are square in user
    /// units and [`TEXELS_PER_CELL`] texels wide where that is possible.
    pub(crate) fn new(canvas_size: [f64; 2], msdf_size: u32) -> Self {
        let cells = msdf_size
            .div_ceil(TEXELS_PER_CELL)
            .clamp(MIN_CELLS, MAX_CELLS);
        Self::with_cells(canvas_size, msdf_size, cells)
    }

    /// The lattice of a drawing whose shapes are all curves. There are no texels then: `msdf_size`
    /// only sets the length of a step.
    pub(crate) fn for_curves(canvas_size: [f64; 2], msdf_size: u32) -> Self {
        Self::with_cells(canvas_size, msdf_size, CURVE_CELLS)
    }

    /// The lattice with cells of half the side, or `None` when cells cannot be smaller.
    pub(crate) fn halved(&self, canvas_size: [f64; 2]) -> Option<Self> {
        let [columns, rows] = self.grid.cell_from_uv_scale;
        // The longer side has a whole number of cells, so the larger scale is that number.
        let cells = 2 * floor_u32(columns.max(rows));
        let unit = self.grid.texels_per_cell.div_ceil(2);
        (cells <= MAX_CELLS).then(|| Self::with_cells(canvas_size, unit * cells, cells))
    }

    fn with_cells(canvas_size: [f64; 2], msdf_size: u32, cells: u32) -> Self {
        let texels_per_cell = msdf_size.div_ceil(cells).clamp(1, MAX_TEXELS_PER_CELL);
        // The longer side has `cells` cells, the other as many as its length asks for, also a
        // fraction.
        let longer = canvas_size[0].max(canvas_size[1]);
        let scale = canvas_size.map(|side| to_f32(side / longer * f64::from(cells)));
        // The evaluator's own f32 arithmetic at uv = 1, the largest uv that it looks up: one cell
        // too few here would send it beyond the grid.
        let size_cells = [0, 1].map(|axis| to_cells((scale[axis] + LATTICE_OFFSET[axis]).floor()));
        let grid = Grid {
            size_cells,
            cell_from_uv_scale: scale,
            cell_from_uv_offset: LATTICE_OFFSET,
            texels_per_cell,
        };
        Self::of_grid(grid, canvas_size)
    }

    /// The lattice of a grid with these numbers under a canvas of `canvas_size` user units.
    pub(crate) fn of_grid(grid: Grid, canvas_size: [f64; 2]) -> Self {
        // The stored f32 numbers, not the ideal ones, place the geometry: it then lies where
        // evaluators look for it.
        let n = f64::from(grid.texels_per_cell);
        let [sx, sy] = grid.cell_from_uv_scale.map(|s| f64::from(s) * n);
        let [ox, oy] = grid.cell_from_uv_offset.map(|o| f64::from(o) * n);
        Self {
            grid,
            lattice_from_canvas: Affine::new([
                sx / canvas_size[0],
                0.0,
                0.0,
                sy / canvas_size[1],
                ox,
                oy,
            ]),
            canvas: Rect::new(ox, oy, ox + sx, oy + sy),
        }
    }

    /// Side of a cell in steps.
    pub(crate) fn cell_steps(&self) -> f64 {
        f64::from(self.grid.texels_per_cell)
    }

    /// Lattice steps along the canvas' longer side.
    pub(crate) fn longer_steps(&self) -> f64 {
        self.canvas.width().max(self.canvas.height())
    }

    /// Number of cells.
    pub(crate) fn cell_count(&self) -> usize {
        self.grid.size_cells[0] as usize * self.grid.size_cells[1] as usize
    }

    /// Columns `[first, last]` and rows `[first, last]` of the cells that `area` meets; `None` when
    /// it lies beside the grid. `area` is in steps.
    pub(crate) fn cells_in(&self, area: Rect) -> Option<[[u32; 2]; 2]> {
        let n = self.cell_steps();
        // Half open: an area that ends before 0 or begins at the end of the grid does not meet it.
        let axis = |low: f64, high: f64, size: u32| {
            let end = f64::from(size);
            let (low, high) = (low / n, high / n);
            let meets = low < end && high >= 0.0;
            meets.then(|| [low, high].map(|x| number::floor_u32(x.clamp(0.0, end - 1.0))))
        };
        let columns = axis(area.x0, area.x1, self.grid.size_cells[0])?;
        let rows = axis(area.y0, area.y1, self.grid.size_cells[1])?;
        Some([columns, rows])
    }

    /// The square of a cell in steps.
    pub(crate) fn cell_rect(&self, column: u32, row: u32) -> Rect {
        let n = self.cell_steps();
        let (x, y) = (f64::from(column) * n, f64::from(row) * n);
        Rect::new(x, y, x + n, y + n)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at most MAX_CELLS and not negative"
)]
fn to_cells(x: f32) -> u32 {
    x as u32 + 1
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "at most MAX_CELLS and not negative"
)]
fn floor_u32(x: f32) -> u32 {
    x as u32
}

#[cfg(test)]
mod tests {
    use super::Lattice;

    #[test]
    fn every_uv_lies_in_a_cell_and_offset_is_a_fraction() {
        for size in [[1.0, 1.0], [300.0, 17.0], [1e-3, 5e4], [640.0, 480.0]] {
            for msdf_size in [1, 63, 64, 512, 1000, 4096] {
                let grid = Lattice::new(size, msdf_size).grid;
                for axis in 0..2 {
                    let last =
                        1.0_f32 * grid.cell_from_uv_scale[axis] + grid.cell_from_uv_offset[axis];
                    assert!(last.floor() < grid.size_cells[axis] as f32, "{grid:?}");
                    assert!(
                        grid.cell_from_uv_offset[axis] >= 0.0
                            && grid.cell_from_uv_offset[axis] < 1.0
                    );
                }
                assert!((1..=64).contains(&grid.texels_per_cell));
            }
        }
    }
}
