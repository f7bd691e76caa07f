//! Groups whose opacity can be multiplied into what they hold.

use kurbo::{Affine, Rect};
use usvg::{BlendMode, Group, Node};

use super::walker::Walker;
use crate::svg::path::{affine, transformed_bounds};

/// Shapes of a translucent group that are compared with each other for overlap.
const MAX_FOLDED_SHAPES: usize = 64;

impl Walker<'_, '_> {
    /// Whether multiplying the group's opacity into its shapes gives the same picture: all of it
    /// is shapes, and no two of them overlap.
    pub(super) fn folds(&self, group: &Group) -> bool {
        let mut shapes = Vec::new();
        self.gather(group, Affine::IDENTITY, &mut shapes) && disjoint(&shapes)
    }

    /// Bounds of every shape; `false` when there is anything else or there are too many.
    fn gather(&self, group: &Group, transform: Affine, shapes: &mut Vec<Rect>) -> bool {
        group.children().iter().all(|node| match node {
            Node::Group(child) => {
                !has_effect(child)
                    && self.gather(child, transform * affine(child.transform()), shapes)
            }
            Node::Path(path) if path.is_visible() => {
                let bounds = transformed_bounds(path.stroke_bounding_box(), transform);
                let parts =
                    usize::from(path.fill().is_some()) + usize::from(path.stroke().is_some());
                shapes.extend(std::iter::repeat_n(bounds, parts));
                shapes.len() <= MAX_FOLDED_SHAPES && self.foreign_paint(path).is_none()
            }
            Node::Path(_) => true,
            Node::Image(image) => !image.is_visible(),
            Node::Text(text) => {
                let inner = affine(text.flattened().transform());
                self.gather(text.flattened(), transform * inner, shapes)
            }
        })
    }
}

/// Whether a group's picture is more than the sum of its shapes, opacity aside.
fn has_effect(group: &Group) -> bool {
    !group.filters().is_empty()
        || group.mask().is_some()
        || group.clip_path().is_some()
        || group.blend_mode() != BlendMode::Normal
}

fn disjoint(shapes: &[Rect]) -> bool {
    let meet = |a: &Rect, b: &Rect| a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    shapes
        .iter()
        .enumerate()
        .all(|(i, a)| shapes[..i].iter().all(|b| !meet(a, b)))
}
