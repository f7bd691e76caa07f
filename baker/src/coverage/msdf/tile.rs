//! One tile: distances from fdsm, signs from the winding.

use fdsm::{
    bezier::prepared::PreparedColoredShape,
    distance::TrackedDistanceAndOrthogonality,
    shape::{ColoredContour, Shape},
};
use nalgebra::Point2;

use super::edges::Edge;
use crate::geometry::Region;

/// Crossings of a shape with the horizontal lines of the lattice.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    first: u32,
    rows: Vec<Vec<(f64, i32)>>,
}

impl Rows {
    /// Lines `first` to `last`, in steps from the lattice's origin.
    pub(crate) fn new(region: &Region, first: u32, last: u32) -> Self {
        Self {
            first,
            rows: (first..=last)
                .map(|row| region.crossings(f64::from(row)))
                .collect(),
        }
    }

    /// Whether the lattice point lies in the region that the lines were made from; `false` on
    /// lines that were not asked for.
    pub(crate) fn contains(&self, region: &Region, column: u32, row: u32) -> bool {
        row.checked_sub(self.first)
            .and_then(|index| self.rows.get(index as usize))
            .is_some_and(|crossings| region.fills_row(crossings, f64::from(column)))
    }
}

/// A shape's part in a tile.
#[derive(Debug)]
pub(crate) struct TileShape<'a> {
    /// Edges within [`TileSpec::reach`] of the tile.
    pub(crate) edges: Vec<&'a Edge>,
    /// Its inside test ...
    pub(crate) region: &'a Region,
    /// ... and where it crosses the tile's lines.
    pub(crate) rows: &'a Rows,
}

/// What a tile is made from.
#[derive(Debug)]
pub(crate) struct TileSpec<'a> {
    /// Lattice column and row of the first texel.
    pub(crate) origin: [u32; 2],
    /// Lattice steps along a side; one texel more is stored.
    pub(crate) steps: u32,
    /// Full width of the stored distances, in steps.
    pub(crate) range: f64,
    /// Edges further away than this many steps count as infinitely far, in every tile alike, so
    /// that neighbouring tiles agree on the texels they share. At least half the range.
    pub(crate) reach: f64,
    /// Shapes that never meet, except under a forced merge.
    pub(crate) shapes: Vec<TileShape<'a>>,
}

/// RGBA8 texels, row by row.
pub(crate) fn render_tile(spec: &TileSpec<'_>) -> Vec<u8> {
    let contour = ColoredContour {
        segments: spec
            .shapes
            .iter()
            .flat_map(|shape| shape.edges.iter().map(|edge| edge.segment))
            .collect(),
    };
    let edges = Shape {
        contours: vec![contour],
    }
    .prepare();
    let side = spec.steps + 1;
    let mut texels = Vec::with_capacity(4 * side as usize * side as usize);
    for y in 0..side {
        for x in 0..side {
            let [column, row] = [spec.origin[0] + x, spec.origin[1] + y];
            let rgb = texel(spec, &edges, column, row);
            texels.extend_from_slice(&rgb);
            texels.push(255);
        }
    }
    texels
}

fn texel(spec: &TileSpec<'_>, edges: &PreparedColoredShape, column: u32, row: u32) -> [u8; 3] {
    let inside = spec
        .shapes
        .iter()
        .any(|shape| shape.rows.contains(shape.region, column, row));
    let p = Point2::new(f64::from(column), f64::from(row));
    let far = if inside { spec.range } else { -spec.range };
    let stored = edges.distance3(p).map(|nearest| {
        let distance = channel_distance(&nearest, p, spec.reach).unwrap_or(far);
        quantise(distance / spec.range + 0.5)
    });
    // The nearest edge's side is not the truth at cusps and where outlines overlap; the winding is.
    if (median(stored) >= 128) == inside {
        stored
    } else {
        stored.map(|v| 255 - v)
    }
}

/// Signed pseudo-distance of a channel, `None` when its nearest edge is beyond `reach`.
fn channel_distance(
    nearest: &TrackedDistanceAndOrthogonality,
    p: Point2<f64>,
    reach: f64,
) -> Option<f64> {
    let near = nearest.value.distance_squared.abs() <= reach * reach;
    let distance = near.then(|| nearest.signed_pseudo_distance(p))?;
    distance.is_finite().then_some(distance)
}

fn median([r, g, b]: [u8; 3]) -> u8 {
    r.min(g).max(r.max(g).min(b))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to [0, 255] and rounded"
)]
fn quantise(v: f64) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0).round() as u8
}
