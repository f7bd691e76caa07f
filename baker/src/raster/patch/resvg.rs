//! Painting a node of the SVG tree by resvg.

use std::panic::{AssertUnwindSafe, catch_unwind};

use kurbo::Affine;
use tiny_skia::Pixmap;

use super::skia::skia_transform;

/// Paints one node; `None` when resvg panics. The transform is from the space of the node's parent.
pub(super) fn paint_node(
    node: &usvg::Node,
    texel_from_parent: Affine,
    pixmap: &mut Pixmap,
) -> Option<()> {
    let Some(bbox) = node.abs_layer_bounding_box() else {
        return Some(());
    };
    // `render_node` moves the node's box to the origin; this moves it back.
    let transform = skia_transform(texel_from_parent).pre_translate(bbox.x(), bbox.y());
    catch_unwind(AssertUnwindSafe(|| {
        resvg::render_node(node, transform, &mut pixmap.as_mut());
    }))
    .ok()
}
