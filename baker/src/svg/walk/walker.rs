//! The state of a walk: what it has found so far, and what a node inherits from its ancestors.

use kurbo::{Affine, BezPath, Rect};
use usvg::{ImageKind, Node};
use vtex_format::{MAX_BLEND_DEPTH, WarningCode};

use super::recolor::Recolor;
use crate::{
    drawing::tree,
    geometry::stroke::StrokeQuality,
    svg::{
        path::{affine, transformed_bounds},
        plan::{PlanItem, Subtree},
    },
    warning::Warnings,
};

/// How far a shape may extend, in canvases. usvg's coordinates are f32: further out neighbouring
/// ones are a sixteenth of a canvas or more apart. A rectangle of that size may still be meant as
/// an endless background, but the arcs of a circle are noise there, and there can be millions of
/// them.
const MAX_EXTENT: f64 = 1_048_576.0;
/// Most path elements of a shape that extends further.
const MAX_FAR_ELEMENTS: usize = 256;
/// Most path elements of all outlines together, with strokes expanded. Later stages hold several
/// copies of each.
pub(super) const MAX_OUTLINE_ELEMENTS: usize = 1 << 22;
/// Most levels of an evaluator's blend stack that the groups and clips around an item may take. Two
/// remain for what the list of a cell adds.
const MAX_DEPTH: u32 = MAX_BLEND_DEPTH - 2;

/// The options that change geometry and colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkOptions {
    /// Pixels along the canvas' longer side at the largest zoom, for which strokes must be right.
    pub(crate) longer_side_px: f64,
    /// Replaces the paint of fills.
    pub(crate) fill_color: Option<[f32; 4]>,
    /// Replaces the paint of strokes.
    pub(crate) stroke_color: Option<[f32; 4]>,
}

/// A walk and what it has found so far.
pub(super) struct Walker<'a, 'w> {
    pub(super) options: WalkOptions,
    pub(super) warnings: &'w Warnings,
    pub(super) canvas: Rect,
    /// The canvas. What does not meet it is left out. While one tile of a pattern is walked to be
    /// copied, it is larger.
    pub(super) window: Rect,
    pub(super) quality: StrokeQuality,
    /// The items so far.
    pub(super) items: Vec<PlanItem<'a>>,
    /// The nodes so far of the group that is being walked.
    pub(super) nodes: Vec<tree::Node>,
    /// Path elements of all outlines so far. Past the limit nothing is added.
    pub(super) element_count: usize,
}

/// What a node inherits from its ancestors.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) canvas_from_user: Affine,
    /// Opacity of the groups around it that were folded. If it is below 1, everything inside can be
    /// folded too, see [`Walker::folds`].
    pub(super) opacity: f32,
    /// Levels of the blend stack that evaluators need for the groups around it.
    pub(super) depth: u32,
    /// The change that a filter around it makes to colours.
    pub(super) recolor: Option<Recolor>,
    /// `id` of the nearest element that has one.
    pub(super) element: &'a str,
}

impl<'a> Place<'a> {
    /// Inside the element with this `id`, which may be empty.
    pub(super) fn named(self, id: &'a str) -> Self {
        Self {
            element: if id.is_empty() { self.element } else { id },
            ..self
        }
    }

    /// The place inside a group that takes `levels` more; `None` when there are too many.
    pub(super) fn deeper(self, levels: u32) -> Option<Self> {
        let depth = self.depth.saturating_add(levels);
        (depth <= MAX_DEPTH).then_some(Self { depth, ..self })
    }
}

impl<'a> Walker<'a, '_> {
    /// Whether a shape extends so far that it must be left out. Warns about it.
    pub(super) fn is_too_far(&self, outline: &BezPath, element: &str) -> bool {
        let bounds = outline.control_box();
        let max_extent = MAX_EXTENT * self.quality.canvas_longer_side;
        let far = bounds.abs().width().max(bounds.abs().height()) > max_extent;
        let left_out = far && outline.elements().len() > MAX_FAR_ELEMENTS;
        if left_out {
            let message = "a shape reaches too far beyond the canvas and is left out";
            self.warnings
                .push(WarningCode::PathFallback, "path", element, message);
        }
        left_out
    }

    /// Index of the next item.
    pub(super) fn next_item(&self) -> u32 {
        u32::try_from(self.items.len()).unwrap_or(u32::MAX)
    }

    /// Adds an item that no node refers to yet, and returns its index.
    pub(super) fn add(&mut self, item: PlanItem<'a>) -> u32 {
        let index = self.next_item();
        self.items.push(item);
        index
    }

    /// Adds an item that is painted at this place of the order.
    pub(super) fn show(&mut self, item: PlanItem<'a>) {
        let index = self.add(item);
        self.nodes.push(tree::Node::Item(index));
    }

    /// Adds a node for resvg to paint as a whole; `feature` says why.
    pub(super) fn raster(&mut self, node: &'a Node, place: Place<'a>, feature: &'static str) {
        let bounds = layer_bounds(node, place.canvas_from_user);
        if !bounds.is_finite() || !self.shows(bounds) {
            return;
        }
        self.show(PlanItem::Raster(Subtree {
            node,
            canvas_from_parent: place.canvas_from_user,
            bounds,
            feature,
            element: own_id(node).unwrap_or(place.element).to_owned(),
        }));
    }

    /// Whether `bounds` meets the window.
    pub(super) fn shows(&self, bounds: Rect) -> bool {
        bounds.x0 < self.window.x1
            && bounds.x1 > self.window.x0
            && bounds.y0 < self.window.y1
            && bounds.y1 > self.window.y0
    }

    /// The nodes that `walk` adds. They are not added to the group that is being walked.
    pub(super) fn collected(&mut self, walk: impl FnOnce(&mut Self)) -> Vec<tree::Node> {
        let outer = std::mem::take(&mut self.nodes);
        walk(self);
        std::mem::replace(&mut self.nodes, outer)
    }
}

/// The `id` of a node, or of the only node inside it: usvg wraps an element with effects in a group
/// without an id.
fn own_id(node: &Node) -> Option<&str> {
    let inner = match node {
        Node::Group(group) => match group.children() {
            [only] if group.id().is_empty() => own_id(only),
            _ => None,
        },
        _ => None,
    };
    inner.or_else(|| Some(node.id()).filter(|id| !id.is_empty()))
}

/// Box of what a node may paint. usvg's `abs_*` boxes would be wrong inside the groups that it
/// makes for colour glyphs.
fn layer_bounds(node: &Node, canvas_from_parent: Affine) -> Rect {
    match node {
        Node::Group(group) => {
            let canvas_from_group = canvas_from_parent * affine(group.transform());
            transformed_bounds(group.layer_bounding_box().to_rect(), canvas_from_group)
        }
        Node::Image(image) => match image.kind() {
            // A nested SVG may draw outside its viewport when `overflow` says so.
            ImageKind::SVG(tree) => {
                let inner = transformed_bounds(
                    tree.root().layer_bounding_box().to_rect(),
                    canvas_from_parent,
                );
                inner.union(transformed_bounds(image.bounding_box(), canvas_from_parent))
            }
            _ => transformed_bounds(image.bounding_box(), canvas_from_parent),
        },
        Node::Path(_) | Node::Text(_) => {
            transformed_bounds(node.stroke_bounding_box(), canvas_from_parent)
        }
    }
}
