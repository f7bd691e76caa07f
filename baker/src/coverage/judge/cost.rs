//! What a kind of coverage costs: bytes in the file and time of a lookup.
//!
//! Both follow from how many cells list a shape and how many segments those cells hold. The counts
//! are estimated from the outline's length, width and number of segments, so that many lattice
//! sizes can be compared without cutting anything.

use kurbo::{Affine, BezPath, Rect, Shape as _};

use super::candidate::Candidate;
use crate::{
    coverage::{curve_lattice::UNIT_PX, curves::lower::LoweredOutline, grid::Lattice},
    geometry::{clip_line, flatten},
    number::count,
};

/// How many sides of unit squares a line of length 1 crosses, averaged over directions.
const CROSSINGS: f64 = 4.0 / std::f64::consts::PI;
/// How far lowering may move a curve when segments are counted, in units of [`UNIT_PX`]. About what
/// records use.
const TOLERANCE_UNITS: f64 = 1.25;

/// What the parts of a file cost. docs/decisions/0008-judge.md says how these numbers were found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Stored bytes of a file without shapes, but with shader and mips.
    pub(super) file_bytes: f64,
    /// Stored bytes of a texel of mip 0, coarser levels included.
    pub(super) mip_texel_bytes: f64,
    /// Stored bytes of a cell's word.
    pub(super) cell_bytes: f64,
    /// Stored bytes of an entry.
    pub(super) entry_bytes: f64,
    /// Stored bytes of a texel of a tile, three channels.
    pub(super) texel_bytes: f64,
    /// Stored bytes of a curve record without segments.
    pub(super) record_bytes: f64,
    /// Stored bytes of a segment of a curve record.
    pub(super) segment_bytes: f64,
    /// Time of a lookup in an empty cell, in ns.
    pub(super) lookup_ns: f64,
    /// Time of an MSDF entry, in ns.
    pub(super) msdf_ns: f64,
    /// Time of a curve entry without segments, in ns.
    pub(super) record_ns: f64,
    /// Time of a segment of a curve entry, in ns.
    pub(super) segment_ns: f64,
}

/// Bytes are from files of the corpus. Times are from llvmpipe, whose lanes wait for each other as
/// those of a GPU do.
pub(super) const RATES: Rates = Rates {
    file_bytes: 16_384.0,
    mip_texel_bytes: 0.3,
    cell_bytes: 0.15,
    entry_bytes: 1.6,
    texel_bytes: 0.8,
    record_bytes: 5.0,
    segment_bytes: 5.5,
    lookup_ns: 80.0,
    msdf_ns: 20.0,
    record_ns: 50.0,
    segment_ns: 12.0,
};

/// Bytes and time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Cost {
    /// Stored bytes.
    pub(super) bytes: f64,
    /// Time of a lookup at a random point of the canvas, in ns.
    pub(super) ns: f64,
}

impl Cost {
    /// The sum.
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            bytes: self.bytes + other.bytes,
            ns: self.ns + other.ns,
        }
    }

    /// One number to compare by: a share of the bytes weighs as much as the same share of the time.
    /// `whole` is what the drawing costs as curves.
    pub(super) fn relative_to(self, whole: Self) -> f64 {
        self.bytes / whole.bytes + self.ns / whole.ns
    }
}

/// The cost of a file without shapes.
pub(super) fn ground(lattice: &Lattice, mip0_size: u32) -> Cost {
    let aspect = lattice.canvas.area() / lattice.longer_steps().powi(2);
    let mip_texels = f64::from(mip0_size).powi(2) * aspect;
    Cost {
        bytes: RATES.file_bytes
            + RATES.mip_texel_bytes * mip_texels
            + RATES.cell_bytes * cells(lattice),
        ns: RATES.lookup_ns,
    }
}

/// What the cost of a shape follows from. Lengths are in user units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    /// Length of the outline on the canvas.
    length: f64,
    /// Mean width of the whole shape: twice the area over the length of the outline.
    pub(super) width: f64,
    /// The part of its box that lies on the canvas.
    visible: Rect,
    /// Number of contours.
    contours: f64,
    /// Number of segments on the canvas, as curve records would hold them.
    segments: f64,
}

impl Extent {
    /// The extent of an outline on a canvas whose longer side is `longer_side_px` pixels at the
    /// largest zoom.
    pub(super) fn new(outline: &BezPath, canvas_size: [f64; 2], longer_side_px: f64) -> Self {
        let canvas = Rect::new(0.0, 0.0, canvas_size[0], canvas_size[1]);
        let tolerance = 1e-3 * canvas.width().max(canvas.height());
        // The whole outline gives the width; only the part on the canvas is stored and looked up.
        let (mut whole, mut length) = (0.0, 0.0);
        let contours = flatten(outline, tolerance);
        for contour in &contours {
            for ends in contour.windows(2) {
                let line = kurbo::Line::new(ends[0], ends[1]);
                whole += (line.p1 - line.p0).hypot();
                length += clip_line(line, canvas).map_or(0.0, |line| (line.p1 - line.p0).hypot());
            }
        }
        if length <= 0.0 {
            return Self::default();
        }
        // Lower it as records would, only to count the segments.
        let px = longer_side_px / canvas.width().max(canvas.height());
        let lowered =
            LoweredOutline::new(&(Affine::scale(px / UNIT_PX) * outline), TOLERANCE_UNITS);
        let segments = lowered.map_or_else(|_| outline.segments().count(), |l| l.segments.len());
        Self {
            length,
            width: 2.0 * outline.area().abs() / whole,
            visible: outline.bounding_box().intersect(canvas),
            contours: count(contours.len()),
            segments: count(segments) * length / whole,
        }
    }

    /// How many cells of `lattice` list the shape, if each is widened by `margin` steps.
    ///
    /// A line of length L meets `s^2 + 4/pi s L` squares of side s around the cells of a unit grid,
    /// averaged over directions and places. Both edges of a thin shape lie in the same squares, so
    /// its length counts half.
    fn listed_cells(&self, lattice: &Lattice, margin: f64) -> f64 {
        let units_per_step = self.units_per_step(lattice);
        let cell = lattice.cell_steps() * units_per_step;
        let side = 1.0 + 2.0 * margin / lattice.cell_steps();
        // 0 for a hairline, whose two edges share all squares; 1 for a shape wider than a square.
        let thickness = (self.width / (side * cell)).min(1.0);
        let length = self.length / cell * 0.5 * (1.0 + thickness);
        // Each contour is a closed line of its own, so each adds the square that it starts in.
        let along = self.contours * side * side + CROSSINGS * side * length;
        // No more than the cells under the box of the shape: a dense outline meets the same cells
        // often.
        let [columns, rows] = [self.visible.width(), self.visible.height()];
        along.min((columns / cell + side) * (rows / cell + side))
    }

    fn units_per_step(&self, lattice: &Lattice) -> f64 {
        1.0 / lattice.lattice_from_canvas.as_coeffs()[0]
    }

    /// The cost as MSDF tiles on the candidate's lattice.
    pub(super) fn as_msdf(&self, candidate: &Candidate) -> Cost {
        let lattice = &candidate.lattice;
        if self.length <= 0.0 {
            return Cost::default();
        }
        let listed = self.listed_cells(lattice, candidate.scales.distances.margin);
        // A tile repeats the texels of its border.
        let texels = (lattice.cell_steps() + 1.0).powi(2);
        Cost {
            bytes: listed * (RATES.entry_bytes + RATES.texel_bytes * texels),
            ns: listed / cells(lattice) * RATES.msdf_ns,
        }
    }

    /// The cost as curve records on a lattice whose cells list edges within `margin` steps.
    pub(super) fn as_curves(&self, lattice: &Lattice, margin: f64) -> Cost {
        if self.length <= 0.0 {
            return Cost::default();
        }
        let listed = self.listed_cells(lattice, margin);
        // The same law for each segment alone.
        let side = 1.0 + 2.0 * margin / lattice.cell_steps();
        let length = self.length / (lattice.cell_steps() * self.units_per_step(lattice));
        let segments = self.segments * side * side + CROSSINGS * side * length;
        Cost {
            bytes: listed * (RATES.entry_bytes + RATES.record_bytes)
                + segments * RATES.segment_bytes,
            ns: (listed * RATES.record_ns + segments * RATES.segment_ns) / cells(lattice),
        }
    }
}

fn cells(lattice: &Lattice) -> f64 {
    let [columns, rows] = lattice.grid.size_cells;
    f64::from(columns) * f64::from(rows)
}
