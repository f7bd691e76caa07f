//! Twin of `vtex/samples_rows.wgsl`: the samples of a footprint.
//!
//! A footprint's parallelogram has rows of four samples, eight of them or fewer, and bit i = 4 k + j of
//! a mask is sample j of row k. Its first axis is horizontal. The samples go down evenly from one to the next, so those
//! between two heights are a range of bits; and no two have the same x.

use super::math::{clamp, to_f32, to_u32};
use super::plane::{Vec2, cross, point, sub};
use super::samples::{Samples, base};
use super::{Lookup, Sampler};
use crate::layout::cmd::{DOWN_BIT, EVEN_ODD_BIT};
use crate::layout::rows::{COLUMNS, EVERY, SAMPLES, SHIFT};

/// A row and a column are no smaller, in cells.
const LEAST: f32 = 1e-12;
/// How far a box may reach beyond its sides, in cells: as much as rounding may take. A canvas ends where
/// an image that fills it does.
const SLACK: f32 = 1e-6;
/// A number for each sample of a row.
type Row = [f32; COLUMNS as usize];
/// The samples of a row, and the columns that they lie in (docs/decisions/0016).
const ROW: Row = [0.0, 1.0, 2.0, 3.0];
const COLUMN: Row = [2.0, 0.0, 3.0, 1.0];
/// Samples of odd rows, of rows with bit 1, and of rows with bit 2.
const ROW_BITS: [u32; 3] = [0xf0f0_f0f0, 0xff00_ff00, 0xffff_0000];
/// Samples whose place in their row is odd, whose place has bit 1 and column is odd, and whose column
/// has bit 1.
const COLUMN_BITS: [u32; 3] = [0xaaaa_aaaa, 0xcccc_cccc, 0x5555_5555];

/// Rows of samples, in cells of the file or in units of a cell's box.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rows {
    /// The first sample's height, from one to the next, and the inverse of that.
    y: f32,
    dy: f32,
    per_y: f32,
    /// Left end of the first row, and from one row to the next.
    x: f32,
    dx: f32,
    /// Width of a column.
    pitch: f32,
    /// How far right in their columns the samples of the first row lie, in eighths.
    shift: u32,
    /// How many there are.
    samples: u32,
}

/// No sample lies farther from the centre, in cells, along x and along y. A bound without a root: the
/// sides of a parallelogram of one covariance add up to no more than sqrt(2) times what theirs do.
pub(super) fn extent([ax, ay, bx, by]: [f32; 4]) -> Vec2 {
    [(ax.abs() + bx.abs()) * 0.7072, (ay.abs() + by.abs()) * 0.5]
}

/// The samples move from pixel to pixel. A line that runs along x or y, or by simple steps like one to
/// two, meets all pixels in the same places: with the same samples in each it would have too much or too
/// little of its ink all along.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Phase {
    /// In parts of the room that each sample has for itself in x and in y.
    moved: Vec2,
    /// By how many eighths of a column all rows are shifted, within their columns.
    shift: u32,
}

impl Phase {
    /// `p` is the lookup's place in cells.
    pub(super) fn new(p: Vec2, [ax, ay, bx, by]: [f32; 4]) -> Self {
        let [x, y] =
            [(p[0], ax.abs() + bx.abs()), (p[1], ay.abs() + by.abs())].map(|(p, extent)| {
                // Divided by the power of two below: exactly, and so alike everywhere. From one pixel to
                // the next it grows by 1 to 2 at most.
                let exponent = extent.max(LEAST).to_bits() & 0x7f80_0000;
                p * f32::from_bits(0x7f00_0000 - exponent)
            });
        let fract = |t: f32| t - t.floor();
        Self {
            // None where there is no extent.
            moved: [0.313 * y, 0.322 * x].map(|t| fract(t + 0.5) - 0.5),
            shift: to_u32(8.0 * fract(0.306 * x + 0.482 * y)),
        }
    }
}

impl Rows {
    /// About `centre`; `axes` are those of the footprint, and it has 2 to `halvings` samples.
    pub(super) fn new(centre: Vec2, axes: [f32; 4], phase: Phase, halvings: u32) -> Self {
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
        let samples = 1 << halvings;
        let count = to_f32(samples);
        // The inverse of the count, exactly.
        let part = f32::from_bits((127 - halvings) << 23);
        let dy = height * part;
        let dx = lean * (to_f32(COLUMNS) * part);
        let pitch = (width * (1.0 / to_f32(COLUMNS))).max(LEAST);
        Self {
            y: centre[1] + (phase.moved[1] - (0.5 * count - 0.5)) * dy,
            dy,
            per_y: count * per_height,
            x: centre[0] - (0.125 * count - 0.125) * dx + (0.125 * phase.moved[0] - 2.0) * pitch,
            dx,
            pitch,
            shift: phase.shift,
            samples,
        }
    }

    /// The same rows in other units.
    fn scaled(&self, units: f32, offset: Vec2) -> Self {
        Self {
            y: self.y * units + offset[1],
            dy: self.dy * units,
            per_y: self.per_y / units,
            x: self.x * units + offset[0],
            dx: self.dx * units,
            pitch: self.pitch * units,
            shift: self.shift,
            samples: self.samples,
        }
    }

    /// How many samples lie above `y`: half open, so that of two segments that meet at a sample's
    /// height one counts.
    fn above(&self, y: f32) -> u32 {
        let count = ((y - self.y) * self.per_y).ceil();
        to_u32(clamp(count, 0.0, to_f32(self.samples)))
    }

    /// Left end of a row's columns, less a half of an eighth, as its samples have it.
    fn start(&self, row: u32) -> f32 {
        let eighths = to_f32((self.shift + SHIFT * row) & 7);
        self.x + to_f32(row) * self.dx + (0.125 * eighths + 0.0625) * self.pitch
    }

    /// How far right of that the samples of a row lie.
    fn across(&self) -> Row {
        std::array::from_fn(|j| 0.25 * self.dx * ROW[j] + self.pitch * COLUMN[j])
    }

    /// The samples in a box, its left and top sides included.
    pub(super) fn within(&self, low: Vec2, high: Vec2) -> u32 {
        let [first, end] = [low, high].map(|corner| self.above(corner[1]));
        let across = self.across();
        let mut mask = 0;
        for row in first / COLUMNS..end.div_ceil(COLUMNS) {
            let start = self.start(row);
            let inside = across.map(|x| start + x >= low[0] && start + x < high[0]);
            mask |= bits(inside) << (4 * row);
        }
        mask & first_of(end) & !first_of(first)
    }

    /// The bits of all.
    pub(super) fn every(&self) -> u32 {
        EVERY >> (SAMPLES - self.samples)
    }

    /// Where a sample lies.
    pub(super) fn place(&self, index: u32) -> Vec2 {
        let across = self.across()[(index % COLUMNS) as usize];
        let x = self.start(index / COLUMNS) + across;
        [x, self.y + to_f32(index) * self.dy]
    }

    /// The mean of samples, from that of all, each taken in the middle of the room that its row and
    /// column give it. From counts of bits.
    fn mean(&self, mask: u32) -> Vec2 {
        let count = |bits: u32| to_f32((mask & bits).count_ones());
        let per_whole = 1.0 / count(EVERY).max(1.0);
        let [one, two, four] = ROW_BITS.map(count);
        let row = one + 2.0 * two + 4.0 * four;
        let [one, right, two] = COLUMN_BITS.map(count);
        let place = one + 2.0 * right;
        let column = right + 2.0 * two;
        let down = (row + 0.25 * place) * per_whole - (0.125 * to_f32(self.samples) - 0.125);
        let across = column * per_whole - 1.5;
        [
            down * self.dx + across * self.pitch,
            down * to_f32(COLUMNS) * self.dy,
        ]
    }
}

/// The samples of a row for which something holds, as four bits.
fn bits(holds: [bool; COLUMNS as usize]) -> u32 {
    let [a, b, c, d] = holds.map(u32::from);
    a | b << 1 | c << 2 | d << 3
}

/// The first samples, so many.
const fn first_of(count: u32) -> u32 {
    // In two shifts, as one of 32 is none.
    let half = count >> 1;
    !((EVERY << half) << (count - half))
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
    /// The lookup's place, and the extent of a cell, in uv.
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
    /// `cell` is the corner of this cell and `centre` the lookup's place, both from the corner of the
    /// cell that it lies in, in cells.
    pub(super) fn new(
        sampler: &Sampler<'_>,
        lookup: &Lookup,
        rows: &Rows,
        cell: Vec2,
        centre: Vec2,
    ) -> Self {
        let s = &sampler.settings;
        let [units, margin] = s.curve_lattice;
        let scaled = rows.scaled(units, cell.map(|c| margin - c * units));
        // From the first row's left end to that of the last sample's.
        let lean = (0.25 * to_f32(rows.samples) - 0.25) * scaled.dx;
        Self {
            rows: *rows,
            cell,
            uv: [lookup.uv, s.scale.map(|scale| 1.0 / scale)],
            units: scaled,
            left: scaled.x + lean.min(0.0),
            right: scaled.x + lean.max(0.0) + 4.0 * scaled.pitch,
            centre: [centre[0] - cell[0], centre[1] - cell[1]],
        }
    }

    /// The samples right of a segment, between the heights of its ends. The test is that of
    /// `segment::winding`, with all products about the upper end: so an edge along y is met at the
    /// same x whatever its length.
    fn right(&self, command: [u32; 4]) -> u32 {
        let rows = &self.units;
        let [a, b] = [point(command[0]), point(command[2])];
        let first = rows.above(a[1]);
        let end = rows.above(b[1]);
        // The GPU's text has no branches; these skip the rest for most segments.
        if first >= end || a[0].min(b[0]) > self.right {
            return 0;
        }
        let heights = first_of(end) & !first_of(first);
        if a[0].max(b[0]) < self.left {
            return heights;
        }
        let [to_c, to_b] = [sub(point(command[1]), a), sub(b, a)];
        let bend = cross(to_c, to_b);
        let across = rows.across();
        let mut mask = 0;
        for row in first / COLUMNS..end.div_ceil(COLUMNS) {
            // From the upper end to the first sample.
            let [x, y] = [
                rows.start(row) - a[0],
                rows.y - a[1] + to_f32(4 * row) * rows.dy,
            ];
            let right = std::array::from_fn(|j| {
                let p = [x + across[j], y + rows.dy * ROW[j]];
                let [chord, before] = [cross(p, to_b), cross(p, to_c)];
                let inner = -4.0 * before * (bend - chord + before);
                let between = chord * bend > 0.0 && chord * chord < inner;
                (chord >= 0.0) != between
            });
            mask |= bits(right) << (4 * row);
        }
        mask & heights
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

    fn within(&self, sampler: &Sampler<'_>, sides: [f32; 4]) -> u32 {
        let s = &sampler.settings;
        let corner = |first: usize, slack: f32| {
            [0, 1].map(|i| {
                let place = self.centre[i] + self.cell[i];
                place + (sides[first + i] - self.uv[0][i]) * s.scale[i] + slack
            })
        };
        self.rows.within(corner(0, -SLACK), corner(2, SLACK))
    }

    fn uv(&self, mask: u32) -> Vec2 {
        let mean = self.rows.mean(mask);
        let [uv, per_cell] = self.uv;
        [0, 1].map(|i| uv[i] + mean[i] * per_cell[i])
    }

    fn q(&self, index: u32) -> Vec2 {
        let place = self.rows.place(index);
        [place[0] - self.cell[0], place[1] - self.cell[1]]
    }

    fn centre(&self) -> Vec2 {
        self.centre
    }
}
