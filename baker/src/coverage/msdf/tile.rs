//! Rendering one tile: distances from fdsm, signs from the winding.

use fdsm::{
    bezier::prepared::PreparedColoredShape,
    distance::TrackedDistanceAndOrthogonality,
    shape::{ColoredContour, Shape},
};
use nalgebra::Point2;

use super::edges::Edge;
use crate::geometry::Region;

/// Crossings of an outline with the horizontal lines of the lattice. Testing the points of a line
/// this way is much faster than testing each alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    first: u32,
    rows: Vec<Vec<(f64, i32)>>,
}

impl Rows {
    /// The crossings with lines `first` to `last`, in steps from the lattice's origin.
    pub(crate) fn new(region: &Region, first: u32, last: u32) -> Self {
        Self {
            first,
            rows: (first..=last)
                .map(|row| region.crossings(f64::from(row)))
                .collect(),
        }
    }

    /// Whether the lattice point lies in `region`, which the rows were made from; `false` on lines
    /// outside the rows.
    pub(crate) fn contains(&self, region: &Region, column: u32, row: u32) -> bool {
        row.checked_sub(self.first)
            .and_then(|index| self.rows.get(index as usize))
            .is_some_and(|crossings| region.fills_row(crossings, f64::from(column)))
    }
}

/// A shape in a tile.
#[derive(Debug)]
pub(crate) struct TileShape<'a> {
    /// Edges within [`TileSpec::max_distance`] of the tile.
    pub(crate) edges: Vec<&'a Edge>,
    /// Its region ...
    pub(crate) region: &'a Region,
    /// ... and the crossings of its outline with the lines of the tile.
    pub(crate) rows: &'a Rows,
}

/// What a tile is rendered from.
#[derive(Debug)]
pub(crate) struct TileSpec<'a> {
    /// Lattice column and row of the first texel.
    pub(crate) origin: [u32; 2],
    /// Lattice steps along a side. One more texel is stored, so that neighbouring tiles repeat the
    /// texels of their common border and a lookup reads one tile.
    pub(crate) steps: u32,
    /// Full width of the stored distances, in steps.
    pub(crate) range: f64,
    /// Edges further away than this many steps count as infinitely far. The rule is the same in
    /// every tile, so neighbouring tiles agree on the texels that they share. At least half the
    /// range.
    pub(crate) max_distance: f64,
    /// The shapes. They do not meet, except after a forced merge.
    pub(crate) shapes: Vec<TileShape<'a>>,
}

/// The RGBA8 texels of the tile, row by row.
pub(crate) fn render_tile(spec: &TileSpec<'_>) -> Vec<u8> {
    // fdsm measures all edges of a contour alike, so the edges of all shapes may form one.
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
    // Without an edge within it a channel holds the end of the range on the right side.
    let far = if inside { spec.range } else { -spec.range };
    let stored = edges.distance3(p).map(|nearest| {
        let distance = channel_distance(&nearest, p, spec.max_distance).unwrap_or(far);
        quantise(distance / spec.range + 0.5)
    });
    // The side of the nearest edge is not always the truth: not at cusps, and not where outlines
    // overlap. The winding is. Mirroring all channels keeps the distance and corrects the sign.
    if (median(stored) >= 128) == inside {
        stored
    } else {
        stored.map(|v| 255 - v)
    }
}

/// Signed pseudo-distance of a channel; `None` when its nearest edge is beyond `max_distance`.
fn channel_distance(
    nearest: &TrackedDistanceAndOrthogonality,
    p: Point2<f64>,
    max_distance: f64,
) -> Option<f64> {
    let near = nearest.value.distance_squared.abs() <= max_distance * max_distance;
    // fdsm divides by lengths that may be 0.
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
