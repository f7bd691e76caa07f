//! Records against brute force over the whole outline.

mod shapes;
mod watertight;

use std::collections::BTreeMap;

use kurbo::{BezPath, ParamCurve, ParamCurveExtrema, ParamCurveNearest, PathSeg, Point};
use vtex_format::{CurveHeader, CurveLattice};
use vtex_shaders::record as curve;

use super::{
    lower::{LoweredOutline, Segment},
    record::encode_record,
    sweep::{CutParams, cut_to_cells},
};
use crate::{
    drawing::FillRule,
    oracle::crossing,
    testing::{Random, closed},
};

/// How far from an edge a lookup may be wrong: the tolerance of lowering and of flattening, a
/// rounded end and a rounded cut, each by half a unit along both axes.
const ERROR_UNITS: f64 = 2.0 * TOLERANCE + 1.5;
const TOLERANCE: f64 = 0.25;

/// One shape as records.
struct Baked {
    params: CutParams,
    lowered: LoweredOutline,
    rule: FillRule,
    covered: BTreeMap<u32, i32>,
    records: BTreeMap<u32, Vec<u32>>,
}

fn params(size: u32, margin: f32) -> CutParams {
    CutParams {
        size_cells: [size; 2],
        lattice: CurveLattice::new(margin).expect("a sensible margin"),
        flatness_units: TOLERANCE,
    }
}

/// Cuts an outline whose unit is a cell.
fn bake(outline: &BezPath, rule: FillRule, params: CutParams) -> Baked {
    let scaled = kurbo::Affine::scale(params.lattice.units_per_cell.into()) * outline.clone();
    let lowered = LoweredOutline::new(&scaled, TOLERANCE).expect("in range");
    let cut = cut_to_cells(&lowered, &params);
    let encode = |(cell, curves)| {
        let words = encode_record(&[&curves], rule).expect("fits a record");
        let header = CurveHeader::decode([words[0], words[1]]).expect("sound");
        assert_eq!(header.record_words() as usize, words.len(), "cell {cell}");
        (cell, words)
    };
    Baked {
        params,
        lowered,
        rule,
        covered: cut.covered.into_iter().collect(),
        records: cut.edges.into_iter().map(encode).collect(),
    }
}

/// A lookup: the cell, the place in its box as evaluators see it, and the same place in units.
#[derive(Clone, Copy, Debug)]
struct Lookup {
    cell: u32,
    p: [f32; 2],
    at: Point,
}

impl Baked {
    /// `at` is in units.
    fn lookup(&self, at: Point) -> Option<Lookup> {
        let [columns, rows] = self.params.size_cells;
        let lattice = self.params.lattice;
        let units = f64::from(lattice.units_per_cell);
        let cell = [at.x, at.y].map(|x| (x / units).floor());
        let inside = cell
            .iter()
            .zip([columns, rows])
            .all(|(&c, n)| c >= 0.0 && c < f64::from(n));
        if !inside {
            return None;
        }
        let margin = f64::from(lattice.margin_units);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounded as evaluators see it"
        )]
        let local = |x: f64, cell: f64| (x - cell * units + margin) as f32;
        let p = [local(at.x, cell[0]), local(at.y, cell[1])];
        let back = |p: f32, cell: f64| f64::from(p) - margin + cell * units;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "inside the grid"
        )]
        let [column, row] = cell.map(|c| c as u32);
        Some(Lookup {
            cell: row * columns + column,
            p,
            at: Point::new(back(p[0], cell[0]), back(p[1], cell[1])),
        })
    }

    fn winding(&self, lookup: Lookup) -> i32 {
        match self.records.get(&lookup.cell) {
            Some(record) => curve::winding(record, lookup.p),
            None => self.covered.get(&lookup.cell).copied().unwrap_or(0),
        }
    }

    fn inside(&self, lookup: Lookup) -> bool {
        fills(self.winding(lookup), self.rule)
    }
}

fn fills(winding: i32, rule: FillRule) -> bool {
    match rule {
        FillRule::NonZero => winding != 0,
        FillRule::EvenOdd => winding % 2 != 0,
    }
}

/// Winding of the lowered outline, every segment, in f64.
fn true_winding(segments: &[Segment], p: Point) -> i32 {
    segments.iter().map(|segment| crossing(segment, p)).sum()
}

/// The parts of an outline along which both coordinates are monotone, with their ends.
fn monotone_ranges(outline: &BezPath) -> Vec<(PathSeg, [f64; 2], [Point; 2])> {
    let mut ranges = Vec::new();
    for segment in outline.segments() {
        for range in segment.extrema_ranges() {
            let t = [range.start, range.end];
            // A line's eval(1) is not bit-exactly its end.
            let at = |t: f64| match t {
                0.0 => segment.start(),
                1.0 => segment.end(),
                _ => segment.eval(t),
            };
            ranges.push((segment, t, t.map(at)));
        }
    }
    ranges
}

/// Winding of the outline as drawn. Kurbo's own winding of cubics is off by up to 1e-3 of their
/// size, so this is by bisection too.
fn exact_winding(ranges: &[(PathSeg, [f64; 2], [Point; 2])], p: Point) -> i32 {
    let one = |(segment, t, ends): &(PathSeg, [f64; 2], [Point; 2])| {
        let down = ends[0].y < ends[1].y;
        let [top, bottom] = if down { [0, 1] } else { [1, 0] };
        if !(ends[top].y <= p.y && p.y < ends[bottom].y) || p.x < ends[0].x.min(ends[1].x) {
            return 0;
        }
        let direction = if down { 1 } else { -1 };
        if p.x >= ends[0].x.max(ends[1].x) {
            return direction;
        }
        let (mut above, mut below) = (t[top], t[bottom]);
        for _ in 0..60 {
            let middle = 0.5 * (above + below);
            if segment.eval(middle).y <= p.y {
                above = middle;
            } else {
                below = middle;
            }
        }
        i32::from(p.x >= segment.eval(above).x) * direction
    };
    ranges.iter().map(one).sum()
}

fn edge_distance(outline: &BezPath, p: Point) -> f64 {
    let nearest = |s: PathSeg| s.nearest(p, 1e-4).distance_sq;
    outline
        .segments()
        .map(nearest)
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}

/// Mismatches of a comparison.
#[derive(Clone, Copy, Debug, Default)]
struct Mismatches {
    samples: u32,
    /// Within [`ERROR_UNITS`] of an edge.
    near: u32,
    /// Anywhere else: must be none.
    far: u32,
    /// Largest distance of a mismatch from the outline as drawn.
    worst_units: f64,
    /// One that is far: where, the winding found, and by both truths.
    example: Option<(Lookup, i32, [i32; 2])>,
}

/// Half the lookups anywhere on the grid, half near an edge or on the heights and columns where
/// segments end, where errors hide.
fn compare(outline: &BezPath, baked: &Baked, samples: u32, seed: u64) -> Mismatches {
    let mut random = Random(seed);
    let scale = f64::from(baked.params.lattice.units_per_cell);
    let scaled = closed(&(kurbo::Affine::scale(scale) * outline.clone()));
    let ranges = monotone_ranges(&scaled);
    let side = scale * f64::from(baked.params.size_cells[0]);
    let segments = &baked.lowered.segments;
    let mut found = Mismatches::default();
    while found.samples < samples {
        let mut at = Point::new(random.unit() * side, random.unit() * side);
        if !segments.is_empty() && random.unit() < 0.5 {
            let segment = segments[random.index(segments.len())];
            let t = random.unit();
            let on = segment.blossom(t, t);
            let spread = 10.0_f64.powf(random.unit() * 5.0);
            match random.index(4) {
                0 => at.y = segment.start.y,
                1 => at.x = segment.start.x,
                _ => {
                    at = on + kurbo::Vec2::new(random.unit() - 0.5, random.unit() - 0.5) * spread;
                }
            }
        }
        let Some(lookup) = baked.lookup(at) else {
            // Outlines may lie beyond the grid.
            found.samples += u32::from(random.unit() < 0.5);
            continue;
        };
        found.samples += 1;
        let winding = baked.winding(lookup);
        let truths = [
            true_winding(segments, lookup.at),
            exact_winding(&ranges, lookup.at),
        ];
        if truths.iter().any(|&truth| truth != winding) {
            let distance = edge_distance(&scaled, lookup.at);
            found.worst_units = distance.max(found.worst_units);
            if distance > ERROR_UNITS {
                found.example = Some((lookup, winding, truths));
                found.far += 1;
            } else {
                found.near += 1;
            }
        }
    }
    found
}
