//! What an SVG comes to: geometry, and subtrees that resvg has to paint.

use kurbo::{Affine, Rect};

use crate::drawing::{ClipOutline, Shape, tree::Tree};

/// A tree sorted into shapes and subtrees to rasterise, in painter's order.
#[derive(Debug)]
pub(crate) struct Plan<'a> {
    /// Width and height of the canvas in user units.
    pub(crate) canvas_size: [f64; 2],
    /// Back to front.
    pub(crate) steps: Vec<Step<'a>>,
    /// How they belong together; items are steps.
    pub(crate) tree: Tree,
}

/// One thing to paint.
#[derive(Debug)]
pub(crate) enum Step<'a> {
    /// Geometry with a paint.
    Shape(Shape),
    /// Where a group may show.
    Clip(ClipOutline),
    /// A subtree for resvg.
    Raster(Subtree<'a>),
}

/// A node that is painted as a whole by resvg.
#[derive(Debug)]
pub(crate) struct Subtree<'a> {
    /// The node.
    pub(crate) node: &'a usvg::Node,
    /// From the space of the node's parent.
    pub(crate) canvas_from_parent: Affine,
    /// What it may touch, in canvas space; not empty, may reach outside the canvas.
    pub(crate) bounds: Rect,
    /// Why it is not geometry.
    pub(crate) feature: &'static str,
    /// `id` of the element or its nearest named ancestor, may be empty.
    pub(crate) element: String,
}
