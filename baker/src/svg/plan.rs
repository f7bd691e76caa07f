//! The result of the walk.

use kurbo::{Affine, Rect};

use crate::drawing::{ClipOutline, Shape, tree::Tree};

/// A drawing in which subtrees still wait to be painted.
#[derive(Debug)]
pub(crate) struct Plan<'a> {
    /// Width and height of the canvas in user units.
    pub(crate) canvas_size: [f64; 2],
    /// Back to front.
    pub(crate) items: Vec<PlanItem<'a>>,
    /// The groups that hold them, by index.
    pub(crate) tree: Tree,
}

/// One element of the plan.
#[derive(Debug)]
pub(crate) enum PlanItem<'a> {
    /// A shape.
    Shape(Shape),
    /// An outline that clips a group.
    Clip(ClipOutline),
    /// A subtree that becomes an image.
    Raster(Subtree<'a>),
}

/// A node that becomes one image.
#[derive(Debug)]
pub(crate) struct Subtree<'a> {
    /// The node.
    pub(crate) node: &'a usvg::Node,
    /// Transform from the space of the node's parent to the canvas.
    pub(crate) canvas_from_parent: Affine,
    /// Box of what it may paint, in canvas space. It meets the canvas and may reach beyond it.
    pub(crate) bounds: Rect,
    /// Why it is not geometry.
    pub(crate) feature: &'static str,
    /// `id` of the element or of its nearest ancestor that has one; may be empty.
    pub(crate) element: String,
}
