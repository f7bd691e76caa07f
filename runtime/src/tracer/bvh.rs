//! Triangles of a scene in the order of an obvhs CWBVH.

use glam::Vec3A;
use obvhs::Boundable;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use obvhs::triangle::Triangle;

/// Share of the nodes the optimiser moves in each of its rounds: obvhs' own medium preset.
const REINSERTION_BATCH_RATIO: f32 = 0.05;
/// Depth below which the builder searches only neighbours: obvhs' own medium preset.
const SEARCH_DEPTH_THRESHOLD: usize = 3;
/// Triangles a leaf may hold; the node layout allows no more.
const MAX_TRIANGLES_PER_LEAF: u32 = 3;

/// Coordinates beyond this are not traced: the triple product of an intersection would overflow. A
/// scene in metres that reaches to Neptune is within it.
const MOST_COORDINATE: f32 = 1.0e12;

/// By how much of its size and of its coordinates a box is enlarged at most while a hierarchy is built.
const JITTER: [f32; 2] = [1.0 / 256.0, 1.0 / 1_048_576.0];
/// Deepest hierarchy that is kept as obvhs builds it, half of what the shader's stack holds. Sizes that
/// grow from one triangle to the next make deeper ones.
const MOST_DEPTH: usize = 15;

/// Builds the hierarchy over triangles or boxes, none of them beyond [`MOST_COORDINATE`]: with an
/// infinite one obvhs comes to no end. Its own `build_cwbvh_from_tris` reads a clock, which panics in
/// a browser, so its steps are called one by one.
pub(crate) fn build<T: Boundable>(primitives: &[T]) -> CwBvh {
    let boxes: Vec<Aabb> = (0..)
        .zip(primitives)
        .map(|(i, p)| jittered(p.aabb(), i))
        .collect();
    let indices = (0..u32::try_from(boxes.len()).unwrap_or(u32::MAX)).collect();
    let mut bvh2 = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Medium,
        &boxes,
        indices,
        SortPrecision::U64,
        SEARCH_DEPTH_THRESHOLD,
    );
    ReinsertionOptimizer::default().run(&mut bvh2, REINSERTION_BATCH_RATIO, None);
    // Converting recurses.
    let levels = match bvh2.nodes.is_empty() {
        true => 0,
        false => bvh2.depth(0),
    };
    if levels <= 8 * MOST_DEPTH {
        // Children are placed so that the shader meets near ones first; it does not read exact boxes.
        let wide = bvh2_to_cwbvh(&bvh2, MAX_TRIANGLES_PER_LEAF, true, false);
        if depth(&wide) <= MOST_DEPTH {
            return wide;
        }
    }
    bvh2_to_cwbvh(&balanced(&boxes), MAX_TRIANGLES_PER_LEAF, true, false)
}

/// Enlarges a box on one side or the other, by shares that differ from one box to the next. The builder
/// joins neighbours that prefer each other; among equal boxes, in even rows or where each is a little
/// larger than the last, all would prefer the same side, and it would join two in each of its rounds.
fn jittered(own: Aabb, index: u32) -> Aabb {
    let size = (own.max - own.min).max_element();
    let most = own.min.abs().max(own.max.abs()).max_element();
    let width = (JITTER[0] * size).max(JITTER[1] * most);
    let above =
        Vec3A::from([0, 1, 2].map(|axis| unit_hash(index.wrapping_mul(3).wrapping_add(axis))));
    Aabb {
        min: own.min - width * (1.0 - above),
        max: own.max + width * above,
    }
}

/// A number in \[0, 1) without a pattern: the finalizer of splitmix32.
fn unit_hash(index: u32) -> f32 {
    let mut bits = index.wrapping_mul(0x9e37_79b9);
    bits = (bits ^ bits >> 16).wrapping_mul(0x21f0_aaad);
    bits = (bits ^ bits >> 15).wrapping_mul(0x735a_2d97);
    ((bits ^ bits >> 15) >> 8) as f32 / 16_777_216.0
}

/// A hierarchy that halves the boxes by their middles along the longest side, again and again.
fn balanced(boxes: &[Aabb]) -> Bvh2 {
    let count = u32::try_from(boxes.len()).unwrap_or(u32::MAX);
    let mut indices: Vec<u32> = (0..count).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..boxes.len())];
    while let Some((node, range)) = open.pop() {
        let own = &mut indices[range.clone()];
        let bounds = own
            .iter()
            .fold(Aabb::empty(), |all, &i| all.union(&boxes[i as usize]));
        let first = if own.len() <= 1 {
            range.start
        } else {
            let size = bounds.max - bounds.min;
            let axis = (0..3).fold(
                0,
                |best, axis| if size[axis] > size[best] { axis } else { best },
            );
            let middle = |i: &u32| boxes[*i as usize].min[axis] + boxes[*i as usize].max[axis];
            let half = own.len() / 2;
            own.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)));
            let first = nodes.len();
            nodes.extend([Bvh2Node::default(); 2]);
            open.push((first, range.start..range.start + half));
            open.push((first + 1, range.start + half..range.end));
            first
        };
        let primitives = u32::from(range.len() == 1);
        nodes[node] = Bvh2Node::new(bounds, primitives, u32::try_from(first).unwrap_or(u32::MAX));
    }
    Bvh2 {
        nodes,
        primitive_indices: indices,
        ..Bvh2::default()
    }
}

/// Deepest path of inner nodes, which bounds the traversal's stack.
pub(crate) fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
    // A list instead of recursion: the depth is what is asked, so nothing bounds it yet.
    let mut open: Vec<(u32, usize)> = if bvh.nodes.is_empty() {
        Vec::new()
    } else {
        vec![(0, 1)]
    };
    while let Some((index, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &bvh.nodes[index as usize];
        for child in (0..8).filter(|&child| !node.is_leaf(child)) {
            open.push((node.child_node_index(child), depth + 1));
        }
    }
    deepest
}

/// Whether a triangle can be built into a hierarchy and met by a ray: its corners are numbers in
/// range, and the square of twice its area is one too, which shading divides by.
pub(crate) fn is_traceable(triangle: &Triangle) -> bool {
    let edges = [triangle.v0 - triangle.v1, triangle.v2 - triangle.v0];
    [triangle.v0, triangle.v1, triangle.v2]
        .into_iter()
        .all(is_within)
        && edges[0].cross(edges[1]).length_squared().is_normal()
}

/// Whether a point is one that can be traced.
pub(crate) fn is_within(point: Vec3A) -> bool {
    // False for what is no number.
    point.abs().cmple(Vec3A::splat(MOST_COORDINATE)).all()
}

/// obvhs' triangle of three corners.
pub(crate) fn triangle(corners: [Vec3A; 3]) -> Triangle {
    let [v0, v1, v2] = corners;
    Triangle { v0, v1, v2 }
}
