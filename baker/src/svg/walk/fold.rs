//! Folding: multiplying the opacity of a group into the paints of its shapes.

use kurbo::{Affine, Rect};
use usvg::{BlendMode, Group, Node};

use super::walker::Walker;
use crate::svg::path::{affine, transformed_bounds};

/// Most shapes of a group that is folded. All pairs are compared for overlap.
const MAX_FOLDED_SHAPES: usize = 64;

impl Walker<'_, '_> {
    /// Whether folding the group gives the same picture. It does if the group holds only shapes and
    /// no two of them overlap: with an overlap the lower shape would show through the upper one.
    pub(super) fn folds(&self, group: &Group) -> bool {
        let mut shapes = Vec::new();
        self.gather(group, Affine::IDENTITY, &mut shapes) && disjoint(&shapes)
    }

    /// Collects the box of every shape; `false` if there is anything else or there are too many.
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
                // Fill and stroke of a path overlap: with both the box is counted twice and meets
                // itself.
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

/// Whether a group does anything to its shapes as a whole, apart from opacity.
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
