//! Limits of the parsed tree, checked before any work on it starts.

use kurbo::Affine;

use crate::{error::BakeError, svg::cost::Cost};

/// Nodes of the tree after `use` is expanded. usvg has a limit of its own as well.
const MAX_NODES: usize = 1 << 20;
/// Path verbs of the tree.
const MAX_SEGMENTS: usize = 1 << 22;
/// Levels of nesting: groups, clip paths, masks, patterns and SVG images all count. Real files stay
/// below 100; usvg allows 1024 nested elements. More could exhaust the stack when the tree is
/// painted.
const MAX_DEPTH: usize = 1024;
/// Longer side of the canvas in texels at which the time of filters is estimated.
const WEIGHED_SIDE: f64 = 512.0;
/// Nanoseconds for the filters of a canvas of that size, without filters that have windows. Patches
/// get coarser until their filters take a few seconds each; beyond this limit they would show
/// little.
const MAX_FILTER_NS: f64 = 2e10;
/// As [`MAX_FILTER_NS`], for filters with windows, whose time falls twice as fast with the size of
/// the patch.
const MAX_WINDOW_NS: f64 = 1.28e12;
/// Largest ratio of the sides of the canvas. Beyond it the shorter side of mip 0 has less than a
/// texel.
const MAX_ASPECT: f32 = 4096.0;

/// Refuses a canvas without an area and a tree with too much in it.
pub(super) fn check_size(tree: &usvg::Tree) -> Result<(), BakeError> {
    let (width, height) = (tree.size().width(), tree.size().height());
    if !(width.is_finite() && height.is_finite() && width > 0.0 && height > 0.0) {
        return Err(BakeError::Svg(format!("canvas of {width} x {height}")));
    }
    if width.max(height) > MAX_ASPECT * width.min(height) {
        return Err(BakeError::Limit(format!(
            "canvas of {width} x {height} is longer than {MAX_ASPECT}:1"
        )));
    }
    let mut census = Census::default();
    census.count(tree.root(), 0);
    if census.too_deep {
        return Err(BakeError::Limit(format!(
            "groups, clip paths, masks and patterns nest deeper than {MAX_DEPTH}"
        )));
    }
    if census.nodes > MAX_NODES {
        return Err(BakeError::Limit(format!("more than {MAX_NODES} nodes")));
    }
    if census.segments > MAX_SEGMENTS {
        return Err(BakeError::Limit(format!(
            "more than {MAX_SEGMENTS} path segments"
        )));
    }
    Ok(())
}

/// Refuses filters that would take too long.
pub(super) fn check_filters(tree: &usvg::Tree) -> Result<(), BakeError> {
    let canvas = [tree.size().width(), tree.size().height()].map(f64::from);
    let scale = WEIGHED_SIDE / canvas[0].max(canvas[1]);
    let cost = Cost::of_group(tree.root(), Affine::IDENTITY, canvas);
    let [filters, windows] = cost.filter_work_ns(scale);
    if filters > MAX_FILTER_NS || windows > MAX_WINDOW_NS {
        return Err(BakeError::Limit(
            "the filters ask for too much work".to_owned(),
        ));
    }
    Ok(())
}

/// Size of a tree. Counting stops just past the limits.
#[derive(Default)]
struct Census {
    nodes: usize,
    segments: usize,
    too_deep: bool,
}

impl Census {
    fn count(&mut self, group: &usvg::Group, depth: usize) {
        self.too_deep |= depth > MAX_DEPTH;
        for node in group.children() {
            // Stop early: a tree past the limits may be huge.
            if self.too_deep || self.nodes > MAX_NODES || self.segments > MAX_SEGMENTS {
                return;
            }
            self.nodes += 1;
            match node {
                usvg::Node::Group(child) => self.count(child, depth + 1),
                usvg::Node::Path(path) => self.segments += path.data().verbs().len(),
                usvg::Node::Image(_) | usvg::Node::Text(_) => {}
            }
            // Clip paths, masks, patterns, flattened text and nested images.
            node.subroots(|root| self.count(root, depth + 1));
        }
    }
}
