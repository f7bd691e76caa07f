//! The walk through usvg's tree, in painter's order.
//!
//! usvg has resolved styles, references and text already. The walk turns paths into shapes: it
//! expands strokes ([`shapes`]) and patterns ([`pattern`]). Groups become groups of the drawing
//! ([`group`],
//! [`clip`]), unless their opacity can be multiplied into their shapes ([`fold`]). Whatever no
//! shape can be is left to resvg as a subtree.

mod clip;
mod fold;
mod gradient;
mod group;
mod pattern;
mod recolor;
mod shapes;
mod style;
mod walker;

use kurbo::{Affine, Rect};
use usvg::{Group, ImageKind, Node};

use crate::{
    drawing::tree::Tree, error::BakeError, geometry::stroke::StrokeQuality, svg::plan::Plan,
    warning::Warnings,
};
use group::{Effects, holds_open_blend};
use walker::{MAX_OUTLINE_ELEMENTS, Place, Walker};

pub(crate) use walker::WalkOptions;

/// Sorts the tree into shapes and subtrees. What lies beside the canvas is left out.
///
/// # Errors
/// [`BakeError::Limit`] when outlines have too many elements together.
pub(crate) fn plan<'a>(
    tree: &'a usvg::Tree,
    options: WalkOptions,
    warnings: &Warnings,
) -> Result<Plan<'a>, BakeError> {
    let canvas_size = [tree.size().width(), tree.size().height()].map(f64::from);
    let canvas = Rect::new(0.0, 0.0, canvas_size[0], canvas_size[1]);
    let mut walker = Walker {
        options,
        warnings,
        canvas,
        window: canvas,
        quality: StrokeQuality {
            canvas_longer_side: canvas_size[0].max(canvas_size[1]),
            longer_side_px: options.longer_side_px,
        },
        items: Vec::new(),
        nodes: Vec::new(),
        element_count: 0,
    };
    let place = Place {
        canvas_from_user: Affine::IDENTITY,
        opacity: 1.0,
        depth: 0,
        recolor: None,
        element: "",
    };
    walker.children(tree.root(), place);
    if walker.element_count > MAX_OUTLINE_ELEMENTS {
        return Err(BakeError::Limit(format!(
            "outlines have more than {MAX_OUTLINE_ELEMENTS} path elements"
        )));
    }
    Ok(Plan {
        canvas_size,
        items: walker.items,
        tree: Tree {
            roots: walker.nodes,
        },
    })
}

impl<'a> Walker<'a, '_> {
    /// Walks the children of a group.
    pub(super) fn children(&mut self, group: &'a Group, place: Place<'a>) {
        for node in group.children() {
            if self.element_count > MAX_OUTLINE_ELEMENTS {
                return;
            }
            self.node(node, place);
        }
    }

    fn node(&mut self, node: &'a Node, place: Place<'a>) {
        let place = place.named(node.id());
        match node {
            Node::Group(group) => self.group(node, group, place),
            Node::Path(path) => self.path(node, path, place),
            Node::Image(image) => match image.kind() {
                _ if !image.is_visible() => {}
                ImageKind::SVG(tree) => self.nested(node, tree, place),
                _ => self.raster(node, place, "image"),
            },
            Node::Text(text) => self.group(node, text.flattened(), place),
        }
    }

    /// An SVG in an `<image>`. Its blend modes see nothing of what lies behind the image.
    fn nested(&mut self, node: &'a Node, tree: &'a usvg::Tree, place: Place<'a>) {
        if !holds_open_blend(tree.root()) {
            return self.children(tree.root(), place);
        }
        let Some(inner) = place.deeper(1) else {
            return self.raster(node, place, "nesting");
        };
        let effects = Effects {
            isolated: true,
            ..Effects::default()
        };
        self.add_group(self.next_item(), effects, |walker| {
            walker.children(tree.root(), inner);
        });
    }
}
