//! What a walk has found so far, and what each place in the tree hands down.

use kurbo::{Affine, BezPath, Rect};
use usvg::{ImageKind, Node};
use vtex_format::{MAX_FRAMES, WarningCode};

use super::recolor::Recolor;
use crate::{
    drawing::tree,
    geometry::stroke::StrokeQuality,
    svg::{
        path::{affine, transformed_bounds},
        plan::{Step, Subtree},
    },
    warning::Warnings,
};

/// Canvas sizes that a shape may reach beyond the canvas. usvg's coordinates are f32: further out
/// they are sixteenths of a canvas apart. A rectangle may still mean a ground without end, but the
/// arcs of a circle are noise there, and millions of them.
const MAX_REACH: f64 = 1_048_576.0;
/// Path elements of a shape that may reach further.
const MAX_FAR_ELEMENTS: usize = 256;
/// Path elements of all outlines together, strokes expanded; the stages that follow hold several
/// copies of each.
pub(super) const MAX_OUTLINE_ELEMENTS: usize = 1 << 22;
/// Frames of an evaluator that groups and clips around an item may take; the rest is for what a list
/// of one cell adds.
const MAX_DEPTH: u32 = MAX_FRAMES - 2;

/// What of the options changes geometry and colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkOptions {
    /// Pixels along the canvas' longer side at the largest zoom, for which strokes must be right.
    pub(crate) longer_side_px: f64,
    /// Replaces fills.
    pub(crate) fill_color: Option<[f32; 4]>,
    /// Replaces strokes.
    pub(crate) stroke_color: Option<[f32; 4]>,
}

/// The steps so far, and the nodes of the group that is being walked.
pub(super) struct Walker<'a, 'w> {
    pub(super) options: WalkOptions,
    pub(super) warnings: &'w Warnings,
    pub(super) canvas: Rect,
    /// What outlines have to meet to be kept: the canvas, unless they are copied elsewhere.
    pub(super) window: Rect,
    pub(super) quality: StrokeQuality,
    pub(super) steps: Vec<Step<'a>>,
    pub(super) nodes: Vec<tree::Node>,
    /// Path elements of all outlines so far; past the limit nothing more is made.
    pub(super) element_count: usize,
}

/// What ancestors hand down.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) canvas_from_user: Affine,
    /// Of folded groups. Below 1 everything further down is plain, see [`Walker::folds`].
    pub(super) opacity: f32,
    /// Frames that evaluators need for the groups around it.
    pub(super) depth: u32,
    /// What a filter around it does to colours.
    pub(super) recolor: Option<Recolor>,
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

    /// Inside a group that takes so many frames; `None` when there are too many.
    pub(super) fn deeper(self, frames: u32) -> Option<Self> {
        let depth = self.depth.saturating_add(frames);
        (depth <= MAX_DEPTH).then_some(Self { depth, ..self })
    }
}

impl<'a> Walker<'a, '_> {
    /// Whether a shape is left out because of its reach; warns.
    pub(super) fn is_too_far(&self, outline: &BezPath, element: &str) -> bool {
        let bounds = outline.control_box();
        let reach = MAX_REACH * self.quality.canvas_longer_side;
        let far = bounds.abs().width().max(bounds.abs().height()) > reach;
        let left_out = far && outline.elements().len() > MAX_FAR_ELEMENTS;
        if left_out {
            let message = "a shape reaches too far beyond the canvas and is left out";
            self.warnings
                .push(WarningCode::PathFallback, "path", element, message);
        }
        left_out
    }

    /// Number that the next item gets.
    pub(super) fn next_item(&self) -> u32 {
        u32::try_from(self.steps.len()).unwrap_or(u32::MAX)
    }

    /// Adds an item, which shows nothing by itself.
    pub(super) fn add(&mut self, step: Step<'a>) -> u32 {
        let item = self.next_item();
        self.steps.push(step);
        item
    }

    /// Adds an item that is painted here.
    pub(super) fn show(&mut self, step: Step<'a>) {
        let item = self.add(step);
        self.nodes.push(tree::Node::Item(item));
    }

    /// Adds a node for resvg to paint as a whole; `feature` says why.
    pub(super) fn raster(&mut self, node: &'a Node, place: Place<'a>, feature: &'static str) {
        let bounds = layer_bounds(node, place.canvas_from_user);
        if !bounds.is_finite() || !self.shows(bounds) {
            return;
        }
        self.show(Step::Raster(Subtree {
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

    /// The nodes that `walk` adds, apart from those of the group it happens in.
    pub(super) fn collected(&mut self, walk: impl FnOnce(&mut Self)) -> Vec<tree::Node> {
        let outer = std::mem::take(&mut self.nodes);
        walk(self);
        std::mem::replace(&mut self.nodes, outer)
    }
}

/// The id of a node, or of the one that it stands for: usvg puts groups around what has effects and
/// leaves the id inside.
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

/// What a node may touch. usvg's `abs_*` boxes are not used: they are wrong inside the groups it
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
