//! How far a shape's distance field is off.

use kurbo::{ParamCurve, ParamCurveArclen, ParamCurveDeriv, PathSeg, Point, Vec2};
use rayon::prelude::*;

use crate::{
    classify::{ShapeCells, classify},
    drawing::{Drawing, Item},
    geometry::floor_index,
    grid::Lattice,
    judge::{Coverage, Verdict},
    msdf::{TileShape, TileSpec, render_tile},
    placed::{Placed, place_item},
    scales::Scales,
};

/// Distance of probes along the outline in steps; texels are a step apart.
const PROBE_STEPS: f64 = 0.5;
/// Probes of one segment; of a longer one some texels stay unseen.
const MAX_PROBES: f64 = 4096.0;
/// Probes beside the edge stand off by this many times the bound on the error.
const STAND_OFF: f64 = 2.0;
/// Accuracy of arc lengths in steps.
const LENGTH_ACCURACY: f64 = 1e-2;

/// Error of a distance field at the wanted zoom.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Measured {
    /// 99th percentile of the edge's displacement, in pixels.
    pub(crate) p99_px: f64,
    /// Share of probes close to the edge that come out on the wrong side.
    pub(crate) wrong: f64,
}

/// Measures every shape of `drawing`; patches get zeros.
pub(super) fn measure(
    drawing: &Drawing,
    lattice: &Lattice,
    scales: Scales,
    px_per_step: f64,
    error_px: f64,
) -> Vec<Measured> {
    let longer = drawing.canvas_size[0].max(drawing.canvas_size[1]);
    let measure_one = |item: &Item| {
        if matches!(item, Item::Patch(_)) {
            return Measured::default();
        }
        let placed = place_item(item, lattice, longer, Verdict::forced(Coverage::Msdf));
        Field::new(&placed, lattice, scales).measure(px_per_step, error_px)
    };
    drawing.items.par_iter().map(measure_one).collect()
}

/// The distance field of one shape alone.
struct Field<'a> {
    placed: &'a Placed,
    lattice: &'a Lattice,
    range: f64,
    cells: ShapeCells,
    /// One a cell of [`ShapeCells::listed`].
    tiles: Vec<Vec<u8>>,
}

impl<'a> Field<'a> {
    fn new(placed: &'a Placed, lattice: &'a Lattice, scales: Scales) -> Self {
        let cells = classify(placed, lattice, scales.distances);
        let columns = lattice.grid.size_cells[0];
        let steps = lattice.grid.texels_per_cell;
        let tile = |&cell: &u32| {
            render_tile(&TileSpec {
                origin: [cell % columns * steps, cell / columns * steps],
                steps,
                range: scales.range,
                reach: scales.distances.reach,
                shapes: vec![TileShape {
                    edges: cells.edges_near(cell).collect(),
                    placed,
                    rows: &cells.rows,
                }],
            })
        };
        let tiles = cells.listed.par_iter().map(tile).collect();
        Self {
            placed,
            lattice,
            range: scales.range,
            cells,
            tiles,
        }
    }

    fn measure(&self, px_per_step: f64, error_px: f64) -> Measured {
        let stand_off = STAND_OFF * error_px / px_per_step;
        let mut off_px = Vec::new();
        let (mut wrong, mut compared) = (0_u32, 0_u32);
        for (p, normal) in probes(&self.placed.outline) {
            let Some(distance) = self.distance(p) else {
                continue;
            };
            off_px.push(distance.abs() * px_per_step);
            for beside in [p + stand_off * normal, p - stand_off * normal] {
                if let Some(distance) = self.distance(beside) {
                    compared += 1;
                    wrong += u32::from((distance > 0.0) != self.placed.region.contains(beside));
                }
            }
        }
        off_px.sort_by(f64::total_cmp);
        let rank = off_px.len() * 99 / 100;
        Measured {
            p99_px: off_px.get(rank).copied().unwrap_or(0.0),
            wrong: f64::from(wrong) / f64::from(compared.max(1)),
        }
    }

    /// The stored distance at `p` in steps, positive inside, as evaluators interpolate it; `None`
    /// beside the canvas and where the shape has no tile.
    fn distance(&self, p: Point) -> Option<f64> {
        if !self.lattice.canvas.contains(p) {
            return None;
        }
        let n = self.lattice.cell_steps();
        let [column, row] = [p.x / n, p.y / n].map(floor_index);
        let cell = row * self.lattice.grid.size_cells[0] as usize + column;
        let cell = u32::try_from(cell).ok()?;
        let tile = &self.tiles[self.cells.listed.binary_search(&cell).ok()?];
        let side = self.lattice.grid.texels_per_cell as usize + 1;
        #[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
        let q = [p.x - column as f64 * n, p.y - row as f64 * n];
        let [x, y] = q.map(|v| floor_index(v).min(side - 2));
        #[expect(clippy::cast_precision_loss, reason = "far below 2^52")]
        let [fx, fy] = [q[0] - x as f64, q[1] - y as f64];
        let channel = |i: usize| {
            let texel = |x: usize, y: usize| f64::from(tile[4 * (y * side + x) + i]);
            let row = |y: usize| texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
            row(y) * (1.0 - fy) + row(y + 1) * fy
        };
        let [r, g, b] = [0, 1, 2].map(channel);
        let median = r.min(g).max(r.max(g).min(b));
        Some((median / 255.0 - 0.5) * self.range)
    }
}

/// Points along an outline with unit normals.
fn probes(outline: &kurbo::BezPath) -> impl Iterator<Item = (Point, Vec2)> {
    outline.segments().flat_map(|segment| {
        let count = (segment.arclen(LENGTH_ACCURACY) / PROBE_STEPS)
            .ceil()
            .clamp(1.0, MAX_PROBES);
        (0..floor_index(count)).filter_map(move |k| {
            #[expect(clippy::cast_precision_loss, reason = "at most MAX_PROBES")]
            let t = (k as f64 + 0.5) / count;
            let direction = tangent(&segment, t);
            let normal = Vec2::new(-direction.y, direction.x).normalize();
            normal.is_finite().then(|| (segment.eval(t), normal))
        })
    })
}

fn tangent(segment: &PathSeg, t: f64) -> Vec2 {
    match segment {
        PathSeg::Line(line) => line.p1 - line.p0,
        PathSeg::Quad(quad) => quad.deriv().eval(t).to_vec2(),
        PathSeg::Cubic(cubic) => cubic.deriv().eval(t).to_vec2(),
    }
}
