//! Triangles of a scene in the order of an obvhs CWBVH.

use glam::Vec3A;
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

/// Builds the hierarchy. obvhs' own `build_cwbvh_from_tris` reads a clock, which panics in a
/// browser, so its steps are called one by one.
pub(crate) fn build(triangles: &[Triangle]) -> CwBvh {
    let count = u32::try_from(triangles.len()).unwrap_or(u32::MAX);
    let mut bvh2 = PlocBuilder::with_capacity(triangles.len()).build(
        PlocSearchDistance::Medium,
        triangles,
        (0..count).collect(),
        SortPrecision::U64,
        SEARCH_DEPTH_THRESHOLD,
    );
    ReinsertionOptimizer::default().run(&mut bvh2, REINSERTION_BATCH_RATIO, None);
    bvh2_to_cwbvh(&bvh2, MAX_TRIANGLES_PER_LEAF, true, false)
}

/// Deepest path of inner nodes, which bounds the traversal's stack.
pub(crate) fn depth(bvh: &CwBvh) -> usize {
    let mut deepest = 0;
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

/// obvhs' triangle of three corners.
pub(crate) fn triangle(corners: [Vec3A; 3]) -> Triangle {
    let [v0, v1, v2] = corners;
    Triangle { v0, v1, v2 }
}
