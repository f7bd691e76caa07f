//! The error of a shape's MSDF: how far it displaces the edge, and where.
//!
//! The tiles of the shape are rendered as the file would store them and interpolated as evaluators
//! do. Probes along the edge ask how far away the field changes its sign; probes on both sides and
//! all over the cells ask whether the sign is right.

use kurbo::{BezPath, Line, ParamCurve, PathSeg, Point, Vec2};
use rayon::prelude::*;
use vtex_format::Finding;

use super::candidate::Candidate;
use crate::{
    coverage::{
        classify::{ShapeCells, classify, tile_spec},
        msdf::render_tile,
        placed::Placed,
    },
    geometry::{flatten, line_line_distance, spread_point, tangent},
    number::{count, floor_index},
};

/// Share of probes that the field may put on the wrong side.
pub(super) const WRONG_SHARE_BOUND: f64 = 1e-3;
/// Distance between probes along the outline, in steps. Texels are one step apart. It grows where
/// there would be more than [`MAX_PROBES`].
const PROBE_STEPS: f64 = 0.25;
/// Most probes of one shape: bounds the time for long outlines. A 99th percentile of as many rests
/// on the 600 largest errors.
const MAX_PROBES: f64 = 65_536.0;
/// Most errors whose cause is determined, spread over all errors.
const MAX_CAUSES: usize = 1024;
/// How far a probe may be from the outline, as a share of the bound on the error.
const FOLLOW_SHARE: f64 = 0.02;
/// Distance of probes beside the edge, in multiples of the bound on the error.
const STAND_OFF: f64 = 2.0;
/// How far the search for a displaced edge goes, in steps, and in how many strides. Strides grow
/// evenly, because small displacements matter most.
const WALK_LENGTH_STEPS: f64 = 2.0;
const WALK_STRIDES: u32 = 64;
/// Slivers thinner than this share of the bound on the error cannot be seen; their edges are not
/// probed. More than [`FOLLOW_SHARE`], or probes beside the outline would look like slivers.
const SLIVER_SHARE: f64 = 0.1;
/// Smallest slope of the field that a displacement is estimated with, in steps of distance for each
/// step.
const FLATTEST_SLOPE: f64 = 0.25;
/// Thickness of a shape or gap, in steps, below which its two edges share texels.
const THIN_STEPS: f64 = 1.5;
/// Errors nearer than this to a sharp corner are attributed to it. A corner of 20 degrees is
/// thinner than [`THIN_STEPS`] up to this distance.
const CUSP_RADIUS_STEPS: f64 = 4.0;
/// Cosine of the largest angle of a sharp corner: 30 degrees.
const CUSP_COSINE: f64 = 0.866;

/// The error of an MSDF at the largest zoom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    /// 99th percentile of the displacement of the edge, in pixels.
    pub(super) p99_px: f64,
    /// Share of probes that the field puts on the wrong side.
    pub(super) wrong: f64,
    /// What most errors beyond the bound are near to.
    pub(super) cause: Finding,
}

impl Measured {
    /// Whether the MSDF may represent the shape.
    pub(super) fn within(&self, error_px: f64) -> bool {
        self.p99_px <= error_px && self.wrong <= WRONG_SHARE_BOUND
    }
}

/// Measures the MSDF that `placed`, which lies on the candidate's lattice, would have alone.
pub(super) fn measure(placed: &Placed, candidate: &Candidate) -> Measured {
    Field::new(placed, candidate).measure()
}

/// The MSDF of one shape alone.
struct Field<'a> {
    placed: &'a Placed,
    candidate: &'a Candidate,
    cells: ShapeCells,
    /// One tile for each cell of [`ShapeCells::listed`].
    tiles: Vec<Vec<u8>>,
}

/// What the probes found.
#[derive(Default)]
struct Tally {
    displacements_px: Vec<f64>,
    compared: u32,
    wrong: u32,
    /// Places of errors beyond the bound, with the normal of the edge if they lie on one.
    errors: Vec<(Point, Vec2)>,
}

impl<'a> Field<'a> {
    fn new(placed: &'a Placed, candidate: &'a Candidate) -> Self {
        let Candidate {
            lattice, scales, ..
        } = candidate;
        // Exactly the tiles that the bake would store if the shape were alone.
        let cells = classify(placed, lattice, scales.distances);
        let tile = |&cell: &u32| {
            let shapes = vec![cells.tile_shape(cell, &placed.region)];
            render_tile(&tile_spec(cell, lattice, scales, shapes))
        };
        let tiles = cells.listed.par_iter().map(tile).collect();
        Self {
            placed,
            candidate,
            cells,
            tiles,
        }
    }

    fn measure(&self) -> Measured {
        let mut tally = Tally::default();
        self.probe_edges(&mut tally);
        self.probe_cells(&mut tally);
        let off = &mut tally.displacements_px;
        off.sort_by(f64::total_cmp);
        Measured {
            p99_px: off.get(off.len() * 99 / 100).copied().unwrap_or(0.0),
            wrong: f64::from(tally.wrong) / f64::from(tally.compared.max(1)),
            cause: self.cause(&tally.errors),
        }
    }

    /// Probes along the edge for its displacement, and beside it for the sign.
    fn probe_edges(&self, tally: &mut Tally) {
        let Candidate {
            px_per_step,
            error_px,
            ..
        } = *self.candidate;
        // From pixels at the largest zoom to steps of the lattice.
        let stand_off = STAND_OFF * error_px / px_per_step;
        let tolerance = FOLLOW_SHARE * error_px / px_per_step;
        let sliver = SLIVER_SHARE * error_px / px_per_step;
        for (p, normal) in probes(&self.placed.outline, tolerance) {
            // The outline passes here only if the two sides differ. They do not where contours
            // overlap or where a sliver is too thin to see.
            let sides = [p + sliver * normal, p - sliver * normal];
            let [left, right] = sides.map(|p| self.placed.region.contains(p));
            let Some(distance) = self.distance(p).filter(|_| left != right) else {
                continue;
            };
            let beside = [1.0, -1.0].map(|side| p + side * stand_off * normal);
            let around = beside.map(|beside| self.distance(beside));
            // Where two edges mix, the field is flatter than a true distance, and its zero is
            // further away than the value says. The slope corrects that.
            let slope = match around {
                [Some(a), Some(b)] => ((a - b) / (2.0 * stand_off)).abs(),
                _ => 1.0,
            };
            let guess = distance.abs() / slope.clamp(FLATTEST_SLOPE, 1.0) * px_per_step;
            // The estimate is good while it is small; a large one is checked by walking.
            let off = if guess > error_px {
                let inwards = if left { normal } else { -normal };
                self.displacement(p, distance, inwards) * px_per_step
            } else {
                guess
            };
            tally.displacements_px.push(off);
            let mut bad = off > error_px;
            for (beside, distance) in beside.into_iter().zip(around) {
                let Some(distance) = distance else { continue };
                tally.compared += 1;
                if self.is_wrong(beside, distance) {
                    tally.wrong += 1;
                    bad = true;
                }
            }
            if bad {
                tally.errors.push((p, normal));
            }
        }
    }

    /// Probes all over the cells that the edge crosses, one between every four texels: the median
    /// of three channels can have the wrong sign far from any edge.
    fn probe_cells(&self, tally: &mut Tally) {
        let lattice = &self.candidate.lattice;
        let columns = lattice.grid.size_cells[0];
        let steps = lattice.grid.texels_per_cell;
        for &cell in &self.cells.listed {
            let corner = [cell % columns, cell / columns].map(|index| index * steps);
            for k in 0..steps * steps {
                let [u, v] = spread_point(k + 1);
                let p = Point::new(
                    f64::from(corner[0] + k % steps) + u,
                    f64::from(corner[1] + k / steps) + v,
                );
                let Some(distance) = self.distance(p) else {
                    continue;
                };
                tally.compared += 1;
                if self.is_wrong(p, distance) {
                    tally.wrong += 1;
                    tally.errors.push((p, Vec2::ZERO));
                }
            }
        }
    }

    /// Whether the stored `distance` at `p` has the wrong sign and `p` is further from the edge
    /// than the bound on the error.
    fn is_wrong(&self, p: Point, distance: f64) -> bool {
        if (distance > 0.0) == self.placed.region.contains(p) {
            return false;
        }
        let bound = self.candidate.error_px / self.candidate.px_per_step;
        let cell = self.cell_at(p).unwrap_or(u32::MAX);
        let mut lines = self.cells.edges_near(cell).flat_map(|edge| edge.lines());
        lines.all(|line| line_line_distance(line, Line::new(p, p)) > bound)
    }

    /// Steps from the edge at `p` to the place where the field changes its sign. The field at `p`
    /// is `distance`: if that is outside, the walk goes inwards, else outwards. It ends at the
    /// middle of the shape or of the gap, because beyond it the next edge answers. If the sign has
    /// not changed by then, the two edges have merged, and the middle is the result.
    fn displacement(&self, p: Point, distance: f64, inwards: Vec2) -> f64 {
        let grown = distance > 0.0;
        let along = if grown { -inwards } else { inwards };
        // Squares of even fractions: the first stride is 1/4096 of the length.
        let spans = (1..=WALK_STRIDES)
            .map(|k| WALK_LENGTH_STEPS * (f64::from(k) / f64::from(WALK_STRIDES)).powi(2));
        let next_edge = |s: f64| self.placed.region.contains(p + s * along) == grown;
        let next = spans.clone().find(|&s| next_edge(s));
        // Half way to the next edge, if there is one within the length.
        let most = next.map_or(WALK_LENGTH_STEPS, |s| 0.5 * s);
        let changes = |s: f64| {
            self.distance(p + s * along)
                .is_some_and(|d| (d > 0.0) != grown)
        };
        let found = spans.take_while(|&s| s < most).find(|&s| changes(s));
        found.unwrap_or(most)
    }

    /// What most of the errors are near to. A sharp corner is thin too, so it is asked about first.
    fn cause(&self, errors: &[(Point, Vec2)]) -> Finding {
        let cusps = cusps(&self.placed.outline);
        let near_cusp = |p: Point| cusps.iter().any(|c| (*c - p).hypot() < CUSP_RADIUS_STEPS);
        let (mut at_cusps, mut thin) = (0, 0);
        // Ask an even selection, because near a bad corner errors are many and alike.
        let every = errors.len().div_ceil(MAX_CAUSES).max(1);
        let asked = errors.iter().step_by(every);
        for &(p, normal) in asked.clone() {
            if near_cusp(p) {
                at_cusps += 1;
            } else if self.is_thin(p, normal) {
                thin += 1;
            }
        }
        match asked.len() {
            // The largest group names the cause, unless most errors have none of these.
            0 => Finding::None,
            all if 2 * at_cusps >= all && at_cusps >= thin => Finding::Cusp,
            all if 2 * (thin + at_cusps) >= all => Finding::ThinFeature,
            _ => Finding::Displaced,
        }
    }

    /// Whether the shape, or the gap beside it, ends within [`THIN_STEPS`] of the edge at `p`.
    fn is_thin(&self, p: Point, normal: Vec2) -> bool {
        [normal, -normal].into_iter().any(|outwards| {
            let at = |steps: f64| self.placed.region.contains(p + steps * outwards);
            // Just outside the edge against further out: they differ if another edge lies between.
            at(0.05) != at(THIN_STEPS)
        })
    }

    /// The cell that contains `p`; `None` beside the canvas.
    fn cell_at(&self, p: Point) -> Option<u32> {
        let lattice = &self.candidate.lattice;
        if !lattice.canvas.contains(p) {
            return None;
        }
        let [column, row] = [p.x, p.y].map(|v| floor_index(v / lattice.cell_steps()));
        let cell = row * lattice.grid.size_cells[0] as usize + column;
        u32::try_from(cell).ok()
    }

    /// The distance at `p` in steps, positive inside, interpolated as evaluators do; `None` beside
    /// the canvas and where the shape has no tile.
    fn distance(&self, p: Point) -> Option<f64> {
        let lattice = &self.candidate.lattice;
        let cell = self.cell_at(p)?;
        let tile = &self.tiles[self.cells.listed.binary_search(&cell).ok()?];
        let n = lattice.cell_steps();
        let [column, row] = [p.x / n, p.y / n].map(floor_index);
        let side = lattice.grid.texels_per_cell as usize + 1;
        let q = [p.x - count(column) * n, p.y - count(row) * n];
        // The last texel of the tile is only ever the far end of an interpolation.
        let [x, y] = q.map(|v| floor_index(v).min(side - 2));
        let [fx, fy] = [q[0] - count(x), q[1] - count(y)];
        let channel = |i: usize| {
            let texel = |x: usize, y: usize| f64::from(tile[4 * (y * side + x) + i]);
            let row = |y: usize| texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
            row(y) * (1.0 - fy) + row(y + 1) * fy
        };
        let [r, g, b] = [0, 1, 2].map(channel);
        // Evaluators use the same median; it rebuilds sharp corners from three smooth fields.
        let median = r.min(g).max(r.max(g).min(b));
        Some((median / 255.0 - 0.5) * self.candidate.scales.range)
    }
}

/// Points evenly spread along an outline, with unit normals. They lie within `tolerance` of it.
fn probes(outline: &BezPath, tolerance: f64) -> Vec<(Point, Vec2)> {
    let contours = flatten(outline, tolerance);
    let lines = || {
        let windows = contours.iter().flat_map(|contour| contour.windows(2));
        windows.map(|ends| Line::new(ends[0], ends[1]))
    };
    let whole: f64 = lines().map(|line| (line.p1 - line.p0).hypot()).sum();
    let spacing = PROBE_STEPS.max(whole / MAX_PROBES);
    let mut probes = Vec::new();
    // The first probe is half a spacing from the start of the outline.
    let mut at = 0.5 * spacing;
    for line in lines() {
        let along = line.p1 - line.p0;
        let length = along.hypot();
        let normal = Vec2::new(-along.y, along.x) / length;
        while at < length {
            probes.push((line.p0 + along * (at / length), normal));
            at += spacing;
        }
        // What is left of the spacing carries over to the next line.
        at -= length;
    }
    probes
}

/// Sharp corners of closed contours: where the outline nearly turns back.
fn cusps(outline: &BezPath) -> Vec<Point> {
    let mut cusps = Vec::new();
    let mut first: Option<PathSeg> = None;
    let mut last: Option<PathSeg> = None;
    let mut visit = |before: Option<PathSeg>, after: Option<PathSeg>| {
        if let (Some(before), Some(after)) = (before, after)
            && before.end() == after.start()
        {
            // Not at the ends themselves, where a handle may have no length.
            let [back, on] = [-tangent(&before, 0.99), tangent(&after, 0.01)].map(Vec2::normalize);
            if back.dot(on) > CUSP_COSINE {
                cusps.push(after.start());
            }
        }
    };
    for segment in outline.segments() {
        // A segment that does not start where the last one ended begins a contour.
        let continues = last.is_some_and(|last| last.end() == segment.start());
        if continues {
            visit(last, Some(segment));
        } else {
            visit(last, first);
            first = Some(segment);
        }
        last = Some(segment);
    }
    visit(last, first);
    cusps
}
