//! Twin of `vtex/samples_rows.wgsl`: the samples of a footprint.
//!
//! A footprint's parallelogram has eight rows of four samples, and bit 4 k + j of a mask is sample j
//! of row k. Its first axis is horizontal: of all parallelograms of one covariance it is the one
//! whose rows an outline crosses at a single x each, so that a segment costs a row's work and not a
//! sample's.

use super::Sampler;
use super::math::{clamp, to_f32, to_u32};
use super::plane::{Vec2, point};
use super::samples::{Samples, base};
use crate::layout::cmd::{DOWN_BIT, EVEN_ODD_BIT, LINE_BIT};
use crate::layout::rows::{COLUMNS, EVERY, ROWS, SHIFTS};

/// A row and a column are no smaller, in cells.
const LEAST: f32 = 1e-12;
/// The four bits of the first row.
const ROW: u32 = (1 << COLUMNS) - 1;
/// Samples of odd rows, of rows with bit 1, and of rows with bit 2.
const ROW_BITS: [u32; 3] = [0xf0f0_f0f0, 0xff00_ff00, 0xffff_0000];
/// Samples of rows whose shift has the bits 1, 2 and 4, in eighths.
const SHIFT_BITS: [u32; 3] = [0x0ff0_ff00, 0xf00f_ff00, 0xf0f0_f00f];
/// Samples of odd columns, and of columns with bit 1.
const COLUMN_BITS: [u32; 2] = [0xaaaa_aaaa, 0xcccc_cccc];

/// Rows of samples, in cells of the file or in units of a cell's box.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rows {
    /// The first row's height, from one to the next, and the inverse of that.
    y: f32,
    dy: f32,
    per_y: f32,
    /// Left end of the first row, and from one to the next.
    x: f32,
    dx: f32,
    /// From one sample to the next, and its inverse.
    pitch: f32,
    per_x: f32,
}

/// No sample lies farther from the centre, in cells, along x and along y. A bound without a root: the
/// sides of a parallelogram of one covariance add up to no more than sqrt(2) times what theirs do.
pub(super) fn extent([ax, ay, bx, by]: [f32; 4]) -> Vec2 {
    [(ax.abs() + bx.abs()) * 0.7072, (ay.abs() + by.abs()) * 0.5]
}

impl Rows {
    /// About `centre`; `axes` are those of the footprint.
    pub(super) fn new(centre: Vec2, axes: [f32; 4]) -> Self {
        let [ax, ay, bx, by] = axes;
        let xy = ax * ay + bx * by;
        let yy = ay * ay + by * by;
        // The parallelogram with a horizontal axis whose covariance is the same.
        let level = yy <= LEAST * LEAST;
        let height = if level { LEAST } else { yy.sqrt() };
        let per_height = 1.0 / height;
        let width = if level {
            ax.abs() + bx.abs()
        } else {
            (ax * by - ay * bx).abs() * per_height
        };
        let lean = if level { 0.0 } else { xy * per_height };
        let dy = height * (1.0 / to_f32(ROWS));
        let dx = lean * (1.0 / to_f32(ROWS));
        let pitch = (width * (1.0 / to_f32(COLUMNS))).max(LEAST);
        Self {
            y: centre[1] - 3.5 * dy,
            dy,
            per_y: to_f32(ROWS) * per_height,
            x: centre[0] - 3.5 * dx - 2.0 * pitch,
            dx,
            pitch,
            per_x: 1.0 / pitch,
        }
    }

    /// The same rows in other units.
    fn scaled(&self, units: f32, offset: Vec2) -> Self {
        let per_unit = 1.0 / units;
        Self {
            y: self.y * units + offset[1],
            dy: self.dy * units,
            per_y: self.per_y * per_unit,
            x: self.x * units + offset[0],
            dx: self.dx * units,
            pitch: self.pitch * units,
            per_x: self.per_x * per_unit,
        }
    }

    /// How many rows lie above `y`: half open, so that of two segments that meet on a row's height
    /// one counts.
    fn above(&self, y: f32) -> u32 {
        to_u32(clamp(((y - self.y) * self.per_y).ceil(), 0.0, to_f32(ROWS)))
    }

    /// Where the first sample of a row lies.
    fn start(&self, row: u32) -> f32 {
        let eighths = to_f32(SHIFTS >> (4 * row) & 7);
        self.x + to_f32(row) * self.dx + (0.125 * eighths + 0.0625) * self.pitch
    }

    /// The samples of a row from `x` on, as its four bits and beyond. `start` is where its first
    /// lies.
    fn from(&self, start: f32, x: f32) -> u32 {
        let left = clamp(((x - start) * self.per_x).ceil(), 0.0, to_f32(COLUMNS));
        ROW << to_u32(left)
    }

    /// The samples in a box, its left and top sides included.
    pub(super) fn within(&self, low: Vec2, high: Vec2) -> u32 {
        let mut mask = 0;
        for row in self.above(low[1])..self.above(high[1]) {
            let start = self.start(row);
            let bits = self.from(start, low[0]) & !self.from(start, high[0]);
            mask |= (bits & ROW) << (4 * row);
        }
        mask
    }

    /// Where a sample lies.
    pub(super) fn place(&self, index: u32) -> Vec2 {
        let row = index >> 2;
        [
            self.start(row) + to_f32(index & 3) * self.pitch,
            self.y + to_f32(row) * self.dy,
        ]
    }

    /// The mean of samples, from counts of bits.
    fn mean(&self, mask: u32) -> Vec2 {
        let count = |bits: u32| to_f32((mask & bits).count_ones());
        let whole = count(EVERY).max(1.0);
        let [one, two, four] = ROW_BITS.map(count);
        let row = one + 2.0 * two + 4.0 * four;
        let [one, two, four] = SHIFT_BITS.map(count);
        let eighths = one + 2.0 * two + 4.0 * four;
        let [one, two] = COLUMN_BITS.map(count);
        let columns = (one + 2.0 * two + 0.125 * eighths) / whole + 0.0625;
        [
            self.x + row / whole * self.dx + columns * self.pitch,
            self.y + row / whole * self.dy,
        ]
    }
}

/// The rows above the one with this number.
const fn until(row: u32) -> u32 {
    // In two shifts, as one of 32 is none.
    !((EVERY << (2 * row)) << (2 * row))
}

/// The windings of all samples about one outline: a bit of each in a word, modulo 32.
pub(super) type Winding = [u32; 5];

/// A footprint's samples as seen from one cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellRows {
    /// In cells, from the corner of the cell that the lookup's centre lies in.
    rows: Rows,
    /// From that corner to this cell's.
    cell: Vec2,
    /// That corner in uv, and the uv of a cell.
    uv: [Vec2; 2],
    /// In units of this cell's box.
    units: Rows,
    /// All samples lie between these, in the same units.
    left: f32,
    right: f32,
    /// The lookup's centre in this cell.
    centre: Vec2,
}

impl CellRows {
    /// `home` is the corner of the centre's cell, `cell` from there to this one's, both in cells.
    pub(super) fn new(
        sampler: &Sampler<'_>,
        rows: &Rows,
        home: Vec2,
        cell: Vec2,
        centre: Vec2,
    ) -> Self {
        let s = &sampler.settings;
        let [units, margin] = s.curve_lattice;
        let scaled = rows.scaled(units, cell.map(|c| margin - c * units));
        Self {
            rows: *rows,
            cell,
            uv: [
                [0, 1].map(|i| (home[i] - s.offset[i]) / s.scale[i]),
                s.scale.map(|scale| 1.0 / scale),
            ],
            units: scaled,
            left: scaled.x + (7.0 * scaled.dx).min(0.0),
            right: scaled.x + (7.0 * scaled.dx).max(0.0) + 4.0 * scaled.pitch,
            centre: [centre[0] - cell[0], centre[1] - cell[1]],
        }
    }

    /// The samples right of a segment, in the rows that it crosses.
    fn right(&self, command: [u32; 4]) -> u32 {
        let rows = &self.units;
        let [a, b] = [point(command[0]), point(command[2])];
        let first = rows.above(a[1]);
        let end = rows.above(b[1]);
        // The GPU's text has no branches; these skip the rest for most segments.
        if first >= end || a[0].min(b[0]) > self.right {
            return 0;
        }
        if a[0].max(b[0]) < self.left {
            return until(end) & !until(first);
        }
        // A line's control point is its upper end: half way makes its parameter linear.
        let c = if command[3] & LINE_BIT != 0 {
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        } else {
            point(command[1])
        };
        // x - x0 = t (x1 + t x2), y - y0 = t (2 half_slope + t bend).
        let [x1, x2] = [2.0 * (c[0] - a[0]), a[0] - 2.0 * c[0] + b[0]];
        let half_slope = c[1] - a[1];
        let bend = a[1] - 2.0 * c[1] + b[1];
        let mut mask = 0;
        for row in first..end {
            // The root that does not cancel: both differences are not negative.
            let down = (rows.y + to_f32(row) * rows.dy - a[1]).max(0.0);
            let root = (half_slope * half_slope + bend * down).max(0.0).sqrt();
            let t = down / (half_slope + root).max(1e-20);
            let x = a[0] + t * (x1 + t * x2);
            mask |= (rows.from(rows.start(row), x) & ROW) << (4 * row);
        }
        mask
    }
}

impl Samples for CellRows {
    type Winding = Winding;

    fn wind(&self, winding: &mut Winding, command: [u32; 4]) {
        let mut carry = self.right(command);
        // All ones to count down.
        let down = if command[3] & DOWN_BIT != 0 { 0 } else { EVERY };
        for bits in winding {
            let next = (*bits ^ down) & carry;
            *bits ^= carry;
            carry = next;
        }
    }

    fn filled(&self, winding: Winding, tag: u32) -> u32 {
        // What the segments' windings are where all of it is none.
        let none = base(tag).wrapping_neg().cast_unsigned();
        let mut some = 0;
        for (bit, bits) in winding.iter().enumerate() {
            some |= bits ^ (none >> bit & 1).wrapping_neg();
        }
        if tag & EVEN_ODD_BIT != 0 {
            winding[0] ^ (none & 1).wrapping_neg()
        } else {
            some
        }
    }

    fn uv(&self, mask: u32) -> Vec2 {
        let mean = self.rows.mean(mask);
        let [home, per_cell] = self.uv;
        [0, 1].map(|i| home[i] + mean[i] * per_cell[i])
    }

    fn q(&self, index: u32) -> Vec2 {
        let place = self.rows.place(index);
        [place[0] - self.cell[0], place[1] - self.cell[1]]
    }

    fn centre(&self) -> Vec2 {
        self.centre
    }
}
