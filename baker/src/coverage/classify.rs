//! Which cells are near an edge of a shape, and which lie inside it: for MSDFs and clips.

use std::collections::BTreeSet;

use kurbo::{BezPath, Line, Rect};

use crate::{
    coverage::{
        grid::Lattice,
        msdf::{EDGE_ERROR_TEXELS, Edge, Rows, TileShape, TileSpec, edges_of},
        placed::Placed,
        scales::{Distances, Scales},
    },
    geometry::{Region, clip_line, flatten, line_box_distance, pieces},
};

/// How far flattening may move an outline when cells are listed, in steps. Less than
/// [`EDGE_ERROR_TEXELS`], which the margin is widened by.
const LISTING_TOLERANCE: f64 = 0.02;

/// A shape on the grid. Cells are indices, row by row.
#[derive(Debug, Default)]
pub(crate) struct ShapeCells {
    /// Its coloured edges.
    pub(crate) edges: Vec<Edge>,
    /// Pairs of a cell and the index of an edge within [`Distances::max_distance`] of it, sorted.
    near: Vec<(u32, u32)>,
    /// Cells with an edge within [`Distances::margin`], ascending.
    pub(crate) listed: Vec<u32>,
    /// Cells that lie inside even when widened by the margin, ascending.
    pub(crate) full: Vec<u32>,
    /// Inside tests at the points of the lattice.
    pub(crate) rows: Rows,
}

impl ShapeCells {
    /// The shape's part in the tile of `cell`; `region` is what was classified.
    pub(crate) fn tile_shape<'a>(&'a self, cell: u32, region: &'a Region) -> TileShape<'a> {
        TileShape {
            edges: self.edges_near(cell).collect(),
            region,
            rows: &self.rows,
        }
    }

    /// Edges that take part in a cell's tile.
    pub(crate) fn edges_near(&self, cell: u32) -> impl Iterator<Item = &Edge> {
        let first = self.near.partition_point(|near| near.0 < cell);
        let last = self.near.partition_point(|near| near.0 <= cell);
        self.near[first..last]
            .iter()
            .map(|near| &self.edges[near.1 as usize])
    }
}

/// The tile of `cell`, of shapes that [`ShapeCells::tile_shape`] gives.
pub(crate) fn tile_spec<'a>(
    cell: u32,
    lattice: &Lattice,
    scales: &Scales,
    shapes: Vec<TileShape<'a>>,
) -> TileSpec<'a> {
    let columns = lattice.grid.size_cells[0];
    let steps = lattice.grid.texels_per_cell;
    TileSpec {
        origin: [cell % columns * steps, cell / columns * steps],
        steps,
        range: scales.range,
        max_distance: scales.distances.max_distance,
        shapes,
    }
}

/// Classifies `placed` against every cell it meets.
pub(crate) fn classify(placed: &Placed, lattice: &Lattice, distances: Distances) -> ShapeCells {
    let mut cells = ShapeCells {
        edges: edges_of(&placed.outline),
        ..ShapeCells::default()
    };
    // Cells further away than the margin cannot list the shape.
    let widened = placed.bounds().inflate(distances.margin, distances.margin);
    let Some([columns, rows]) = lattice.cells_in(widened) else {
        return ShapeCells::default();
    };
    bin_edges(&mut cells, &placed.outline, lattice, distances);
    let n = lattice.grid.texels_per_cell;
    cells.rows = Rows::new(&placed.region, rows[0] * n, (rows[1] + 1) * n);
    // Both lists of cells are ascending: walk them together.
    let mut listed = cells.listed.iter().copied().peekable();
    for row in rows[0]..=rows[1] {
        for column in columns[0]..=columns[1] {
            let cell = row * lattice.grid.size_cells[0] + column;
            while listed.next_if(|&other| other < cell).is_some() {}
            if listed.peek() == Some(&cell) {
                continue;
            }
            // No edge is near, so any one point decides for the whole cell.
            let [x, y] = [column, row].map(|index| index * n + n / 2);
            if cells.rows.contains(&placed.region, x, y) {
                cells.full.push(cell);
            }
        }
    }
    cells
}

/// Finds the cells near the outline, and those near the coloured edges.
///
/// The two differ: colouring drops slivers, which distances cannot resolve, but a cell must list
/// the shape for them all the same.
fn bin_edges(cells: &mut ShapeCells, outline: &BezPath, lattice: &Lattice, distances: Distances) {
    // Evaluators see the outline; distances are measured to edges that may lie this much beside it.
    let margin = distances.margin + EDGE_ERROR_TEXELS;
    let mut listed = BTreeSet::new();
    for contour in flatten(outline, LISTING_TOLERANCE) {
        for ends in contour.windows(2) {
            let line = Line::new(ends[0], ends[1]);
            listed.extend(cells_near(line, lattice, margin));
        }
    }
    let mut near = BTreeSet::new();
    for (index, edge) in (0_u32..).zip(&cells.edges) {
        for line in edge.lines() {
            // At least the margin, so that a listed cell never lacks the edge that it is listed
            // for.
            let found = cells_near(line, lattice, distances.max_distance.max(margin));
            near.extend(found.into_iter().map(|cell| (cell, index)));
        }
    }
    cells.near = near.into_iter().collect();
    cells.listed = listed.into_iter().collect();
}

/// Cells within `max_distance` of `line`.
fn cells_near(line: Line, lattice: &Lattice, max_distance: f64) -> Vec<u32> {
    // A line far beside the canvas would be cut into as many pieces as it has cells of length.
    let beyond = max_distance + 2.0 * lattice.cell_steps();
    let mut near = Vec::new();
    let Some(line) = clip_line(line, lattice.canvas.inflate(beyond, beyond)) else {
        return near;
    };
    // Short pieces, because the cells of a long diagonal line's box are mostly far from the line.
    for piece in pieces(line, lattice.cell_steps()) {
        let area = Rect::from_points(piece.p0, piece.p1).inflate(max_distance, max_distance);
        let Some([columns, rows]) = lattice.cells_in(area) else {
            continue;
        };
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                if line_box_distance(piece, lattice.cell_rect(column, row)) <= max_distance {
                    near.push(row * lattice.grid.size_cells[0] + column);
                }
            }
        }
    }
    near
}
