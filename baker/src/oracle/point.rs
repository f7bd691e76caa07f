//! Lookups at a point: every outline is tested, and the items that contain the point are
//! composited.
//!
//! It shares with curve records what they are made from: monotone lines and quadratics between
//! points of the curve lattice ([`LoweredOutline`]). It shares nothing of what is done with them:
//! it has no cells, no cuts, no steps, no layers and no f32.

use kurbo::{Affine, Point};
use vtex_format::{COVERAGE_CURVES, VtexFile};
use vtex_shaders::srgb;

use super::{gradient, tree::Covering};
use crate::{
    BakeError,
    config::{BakeConfig, Resources},
    coverage::{
        curve_lattice::flatness_units,
        curves::lower::{LoweredOutline, Segment},
        grid::Lattice,
    },
    drawing::{
        FillRule, Item, Paint,
        tree::{Node, Tree},
    },
    geometry::prepare::clean,
    number::floor_index,
};

/// Bands of height that segments are sorted into.
const ROWS: usize = 4096;
/// Places along a segment that each round of the search for its nearest point tries.
const PLACES: u32 = 64;

/// Answers lookups at points from the outlines of a drawing. Slow.
#[derive(Debug)]
pub struct Oracle {
    units_per_uv: [f64; 2],
    offset_units: [f64; 2],
    tree: Tree,
    /// Front to back.
    shapes: Vec<Painted>,
    /// The segments of all shapes, shape by shape from the front.
    segments: Vec<Segment>,
    /// For each band, from the top, the indices of the segments that reach into it, ascending.
    rows: Vec<Vec<u32>>,
    rows_per_unit: f64,
}

#[derive(Debug)]
struct Painted {
    /// `None` for a clip outline.
    paint: Option<Paint>,
    rule: FillRule,
    /// One past its last segment.
    end: u32,
}

impl Oracle {
    /// The oracle of `svg`, on the curve lattice of `file`, which was baked from it with `config`.
    ///
    /// `None` when the file holds anything but curves.
    ///
    /// # Errors
    /// As [`crate::bake`].
    pub fn new(
        svg: &[u8],
        config: &BakeConfig,
        resources: &Resources,
        file: &VtexFile,
    ) -> Result<Option<Self>, BakeError> {
        let drawing = crate::pipeline::draw(svg, config, resources, &|_| ())?;
        let all_curves = file.shapes.iter().all(|s| s.coverage == COVERAGE_CURVES);
        let Some(lattice) = file.meta.curve_lattice.filter(|_| all_curves) else {
            return Ok(None);
        };
        let steps = Lattice::of_grid(file.meta.grid, drawing.canvas_size);
        let units_per_step = f64::from(lattice.units_per_cell) / steps.cell_steps();
        let units_from_canvas = Affine::scale(units_per_step) * steps.lattice_from_canvas;
        let canvas = steps.canvas.scale_from_origin(units_per_step);
        let rows = f64::from(file.meta.grid.size_cells[1] * lattice.units_per_cell);
        let canvas_longer = drawing.longer_side();
        let mut oracle = Self {
            units_per_uv: [canvas.width(), canvas.height()],
            offset_units: [canvas.x0, canvas.y0],
            tree: drawing.tree,
            shapes: Vec::new(),
            segments: Vec::new(),
            rows: vec![Vec::new(); ROWS],
            rows_per_unit: ROWS as f64 / rows,
        };
        let tolerance = f64::from(flatness_units(&steps, lattice, config.longer_side_px()));
        for item in drawing.items.iter().rev() {
            let (outline, rule, paint) = match item {
                Item::Shape(shape) => (&shape.outline, shape.fill_rule, Some(&shape.paint)),
                Item::Clip(clip) => (&clip.outline, clip.rule, None),
                Item::Image(_) => return Ok(None),
            };
            let outline = units_from_canvas * clean(outline, canvas_longer);
            let Ok(lowered) = LoweredOutline::new(&outline, tolerance) else {
                return Ok(None);
            };
            oracle.push(lowered, rule, paint.cloned());
        }
        oracle.sort_into_rows();
        Ok(Some(oracle))
    }

    fn push(&mut self, lowered: LoweredOutline, rule: FillRule, paint: Option<Paint>) {
        self.segments.extend(lowered.segments);
        self.shapes.push(Painted {
            paint,
            rule,
            end: u32::try_from(self.segments.len()).unwrap_or(u32::MAX),
        });
    }

    fn sort_into_rows(&mut self) {
        for (index, segment) in (0_u32..).zip(&self.segments) {
            let [first, last] = [segment.start.y, segment.end.y].map(|y| self.row_of(y));
            for row in &mut self.rows[first..=last] {
                row.push(index);
            }
        }
    }

    fn row_of(&self, y: f64) -> usize {
        floor_index((y * self.rows_per_unit).clamp(0.0, ROWS as f64 - 1.0))
    }

    fn point(&self, uv: [f32; 2]) -> Point {
        let [x, y] = [0, 1]
            .map(|axis| f64::from(uv[axis]) * self.units_per_uv[axis] + self.offset_units[axis]);
        Point::new(x, y)
    }

    /// The uv of the upper end of a segment: a place where cuts and comparisons meet. `lot` is any
    /// number; it chooses the segment. `None` when there are no segments.
    pub fn corner(&self, lot: u64) -> Option<[f64; 2]> {
        let count = self.segments.len() as u64;
        let index = usize::try_from(lot % count.max(1)).ok()?;
        let corner = self.segments.get(index)?.start;
        let axis = |axis: usize, at: f64| (at - self.offset_units[axis]) / self.units_per_uv[axis];
        Some([axis(0, corner.x), axis(1, corner.y)])
    }

    /// What a point lookup must return at `uv`, which is in \[0, 1\]^2: linear light,
    /// premultiplied.
    pub fn color(&self, uv: [f32; 2]) -> [f32; 4] {
        let mut items = self.covering(uv);
        // The tree is painted back to front.
        items.reverse();
        let covering = Covering {
            items: &items,
            color: |item: u32| self.paint_of(item, uv),
        };
        linear(covering.paint(&self.tree.roots, [0.0; 4]))
    }

    /// The items that contain `uv`, front to back. Without groups it stops at the first opaque one.
    fn covering(&self, uv: [f32; 2]) -> Vec<u32> {
        let p = self.point(uv);
        let plain = self
            .tree
            .roots
            .iter()
            .all(|node| matches!(node, Node::Item(_)));
        // Segments of the row come shape by shape from the front, as `segments` are sorted.
        let mut row = self.rows[self.row_of(p.y)].iter().copied().peekable();
        let mut first = 0;
        let mut items = Vec::new();
        // A shape without a segment in the row does not contain the point.
        while let Some(&next) = row.peek() {
            let index = first + self.shapes[first..].partition_point(|shape| shape.end <= next);
            let Some(shape) = self.shapes.get(index) else {
                break;
            };
            let mut winding = 0;
            while let Some(index) = row.next_if(|&index| index < shape.end) {
                winding += crossing(&self.segments[index as usize], p);
            }
            first = index + 1;
            if shape.rule.fills(winding) {
                let item = u32::try_from(self.shapes.len() - first).unwrap_or(u32::MAX);
                items.push(item);
                if plain && self.paint_of(item, uv)[3] >= 1.0 {
                    break;
                }
            }
        }
        items
    }

    /// Colour of an item, straight alpha, sRGB-encoded.
    fn paint_of(&self, item: u32, uv: [f32; 2]) -> [f64; 4] {
        let shape = &self.shapes[self.shapes.len() - 1 - item as usize];
        let paint = shape.paint.as_ref();
        paint.map_or([0.0; 4], |paint| color_at(paint, uv))
    }

    /// Distance from `uv` to the nearest outline, in units of the curve lattice; infinite if it is
    /// more than `reach_units`.
    pub fn edge_distance_units(&self, uv: [f32; 2], reach_units: f64) -> f64 {
        let p = self.point(uv);
        let rows = self.row_of(p.y - reach_units)..=self.row_of(p.y + reach_units);
        let near = self.rows[rows].iter().flatten().map(|&index| {
            let segment = &self.segments[index as usize];
            let beside = p.x < segment.x_min() - reach_units || p.x > segment.x_max() + reach_units;
            if beside {
                f64::INFINITY
            } else {
                distance(segment, p)
            }
        });
        let nearest = near.fold(f64::INFINITY, f64::min);
        if nearest <= reach_units {
            nearest
        } else {
            f64::INFINITY
        }
    }
}

/// What `segment` adds to the winding at `p`: its direction, if it crosses the height of `p` to the
/// left of it. Half open, as the format says.
pub(crate) fn crossing(segment: &Segment, p: Point) -> i32 {
    let crosses = segment.start.y <= p.y && p.y < segment.end.y;
    if !crosses || p.x < segment.x_min() {
        return 0;
    }
    let met = p.x >= segment.x_max() || p.x >= x_at(segment, p.y);
    if met { segment.direction } else { 0 }
}

/// The x of the segment at height `y`, by bisection: y grows along it.
fn x_at(segment: &Segment, y: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if segment.blossom(middle, middle).y <= y {
            low = middle;
        } else {
            high = middle;
        }
    }
    segment.blossom(low, low).x
}

fn distance(segment: &Segment, p: Point) -> f64 {
    let (mut from, mut to) = (0.0, 1.0);
    let mut best = (f64::INFINITY, 0.0);
    // Each round searches around the best place of the round before, 32 times as closely.
    for _ in 0..5 {
        let step = (to - from) / f64::from(PLACES);
        for place in 0..=PLACES {
            let t = from + step * f64::from(place);
            let far = segment.blossom(t, t).distance(p);
            if far < best.0 {
                best = (far, t);
            }
        }
        (from, to) = ((best.1 - step).max(0.0), (best.1 + step).min(1.0));
    }
    best.0
}

/// Straight alpha, sRGB-encoded.
fn color_at(paint: &Paint, uv: [f32; 2]) -> [f64; 4] {
    match paint {
        Paint::Solid(color) => color.map(f64::from),
        Paint::Gradient(gradient) => gradient::color_at(gradient, uv.map(f64::from)),
    }
}

fn linear(premultiplied: [f64; 4]) -> [f32; 4] {
    let [r, g, b, a] = premultiplied;
    if a <= 0.0 {
        return [0.0; 4];
    }
    #[expect(clippy::cast_possible_truncation, reason = "lookups return f32")]
    let [straight @ .., alpha] = [r / a, g / a, b / a, a].map(|c| c as f32);
    let [r, g, b] = straight.map(|c| srgb::decode(c) * alpha);
    [r, g, b, alpha]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oracle(svg: &str) -> Oracle {
        let (config, resources) = (BakeConfig::default(), Resources::default());
        let file = crate::bake(svg.as_bytes(), &config, &resources).unwrap();
        let oracle = Oracle::new(svg.as_bytes(), &config, &resources, &file);
        oracle.unwrap().unwrap()
    }

    #[test]
    fn what_is_in_front_shows() {
        let oracle = oracle(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10'>\
             <path d='M2 2H8V8H2z' fill='#f00'/><circle cx='5' cy='5' r='1' fill='#00f'/>\
             <path d='M6 2H8V8H6z' fill='#fff' fill-opacity='.5'/></svg>",
        );
        assert_eq!(oracle.color([0.1, 0.5]), [0.0; 4]);
        assert_eq!(oracle.color([0.3, 0.5]), [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(oracle.color([0.5, 0.5]), [0.0, 0.0, 1.0, 1.0]);
        let [r, g, b, a] = oracle.color([0.7, 0.5]);
        let half = srgb::decode(0.5);
        assert!(
            (g - half).abs() < 1e-6 && (b - half).abs() < 1e-6,
            "{g} {b}"
        );
        assert_eq!([r, a], [1.0; 2]);
    }

    #[test]
    fn distances_are_in_units_of_the_lattice() {
        let oracle = oracle(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10'>\
             <circle cx='5' cy='5' r='3'/></svg>",
        );
        let step = 1.0 / oracle.units_per_uv[0];
        for (off, expected) in [(3.0, 3.0), (-3.0, 3.0), (0.0, 0.0)] {
            let x = 0.8 + off * step;
            #[expect(clippy::cast_possible_truncation, reason = "lookups take f32")]
            let found = oracle.edge_distance_units([x as f32, 0.5], 20.0);
            // The lattice, lowering and f32 of the lookup: a unit or two.
            assert!((found - expected).abs() < 2.0, "{off}: {found}");
        }
        assert!(oracle.edge_distance_units([0.5, 0.5], 20.0).is_infinite());
    }
}
