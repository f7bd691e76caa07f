//! Clip paths, as unions and intersections of outlines.

use kurbo::{Affine, BezPath, PathEl, Rect};
use usvg::{ClipPath, Group, Node};

use super::{style::fill_rule, walker::Walker};
use crate::{
    drawing::{
        ClipOutline, FillRule,
        tree::{Clip, ClipPart},
    },
    svg::{
        path::{affine, bez_path, close_subpaths},
        plan::PlanItem,
    },
};

/// The union of the members of a clip path.
enum Union {
    /// It contains the canvas.
    All,
    /// Its parts; none if it is empty.
    Parts(Vec<ClipPart>),
}

impl Walker<'_, '_> {
    /// The clips of a clip path and of the clip paths on it; a point must lie in all of them.
    /// `None` if nothing can show. usvg gives the `clip-rule` as the rule of a fill.
    pub(super) fn clips(&mut self, path: &ClipPath, canvas_from_user: Affine) -> Option<Vec<Clip>> {
        // A clip path on a clip path is intersected with it.
        let mut clips = match path.clip_path() {
            Some(outer) => self.clips(outer, canvas_from_user)?,
            None => Vec::new(),
        };
        let canvas_from_clip = canvas_from_user * affine(path.transform());
        match self.union(path.root(), canvas_from_clip) {
            Union::All => {}
            Union::Parts(parts) if parts.is_empty() => return None,
            Union::Parts(parts) => clips.push(Clip { parts }),
        }
        Some(clips)
    }

    /// The clip to one outline, or none if it contains the canvas; `None` if nothing can show.
    pub(super) fn clip_to(&mut self, outline: BezPath, rule: FillRule) -> Option<Vec<Clip>> {
        if self.holds_canvas(&outline) {
            return Some(Vec::new());
        }
        let parts = vec![self.clip_part(outline, rule)?];
        Some(vec![Clip { parts }])
    }

    fn union(&mut self, group: &Group, canvas_from_group: Affine) -> Union {
        let mut parts = Vec::new();
        for node in group.children() {
            let more = match node {
                Node::Path(path) if path.is_visible() => {
                    let Some(fill) = path.fill() else { continue };
                    let outline = canvas_from_group * close_subpaths(&bez_path(path.data()));
                    // The usual clip of exporters: a rectangle around the page.
                    if self.holds_canvas(&outline) {
                        return Union::All;
                    }
                    let rule = fill_rule(fill.rule());
                    Union::Parts(self.clip_part(outline, rule).into_iter().collect())
                }
                Node::Text(text) => self.union(text.flattened(), canvas_from_group),
                Node::Group(inner) => self.clipped_union(inner, canvas_from_group),
                // Invisible paths and images do not clip.
                Node::Path(_) | Node::Image(_) => continue,
            };
            match more {
                Union::All => return Union::All,
                Union::Parts(more) => parts.extend(more),
            }
        }
        Union::Parts(parts)
    }

    /// The union of a group inside a clip path. The group may be clipped itself.
    fn clipped_union(&mut self, group: &Group, canvas_from_parent: Affine) -> Union {
        let canvas_from_group = canvas_from_parent * affine(group.transform());
        let Some(clip) = group.clip_path() else {
            return self.union(group, canvas_from_group);
        };
        let Some(clips) = self.clips(clip, canvas_from_group) else {
            return Union::Parts(Vec::new());
        };
        let mut parts = match self.union(group, canvas_from_group) {
            Union::Parts(parts) => parts,
            Union::All if clips.is_empty() => return Union::All,
            // The clips alone decide. They need an outline to apply to: one around the canvas.
            Union::All => {
                let canvas = kurbo::Shape::to_path(&self.canvas.inflate(1.0, 1.0), 0.1);
                self.clip_part(canvas, FillRule::NonZero)
                    .into_iter()
                    .collect()
            }
        };
        for part in &mut parts {
            // The clips of the group apply to each of its parts.
            part.clips.extend(clips.iter().cloned());
        }
        Union::Parts(parts)
    }

    /// The outline as an item; `None` if nothing of it shows.
    fn clip_part(&mut self, outline: BezPath, rule: FillRule) -> Option<ClipPart> {
        let bounds = outline.control_box();
        let shows = outline.is_finite() && bounds.area() > 0.0 && self.shows(bounds);
        if !shows || self.is_too_far(&outline, "") {
            return None;
        }
        self.element_count += outline.elements().len();
        let item = self.add(PlanItem::Clip(ClipOutline { outline, rule }));
        Some(ClipPart {
            item,
            clips: Vec::new(),
        })
    }

    /// Whether the outline is a rectangle that contains the canvas: it clips nothing.
    fn holds_canvas(&self, outline: &BezPath) -> bool {
        let canvas = self.canvas;
        upright_box(outline).is_some_and(|area| {
            area.x0 <= canvas.x0
                && area.y0 <= canvas.y0
                && area.x1 >= canvas.x1
                && area.y1 >= canvas.y1
        })
    }
}

/// The rectangle, if the outline is one with sides along the axes.
fn upright_box(outline: &BezPath) -> Option<Rect> {
    let mut corners = Vec::with_capacity(5);
    for element in outline.elements() {
        match *element {
            PathEl::MoveTo(p) if corners.is_empty() => corners.push(p),
            PathEl::LineTo(p) if corners.len() < 5 => corners.push(p),
            PathEl::ClosePath => {}
            _ => return None,
        }
    }
    if corners.len() == 5 && corners[4] == corners[0] {
        corners.pop();
    }
    let [a, b, c, d] = corners[..] else {
        return None;
    };
    let across = a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x;
    let along = a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y;
    (across || along).then(|| Rect::from_points(a, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upright_boxes_are_found() {
        let of = |path: &str| upright_box(&BezPath::from_svg(path).unwrap());
        let expected = Some(Rect::new(1.0, 2.0, 5.0, 9.0));
        assert_eq!(of("M1 2H5V9H1z"), expected);
        assert_eq!(of("M1 2V9H5V2H1z"), expected);
        assert_eq!(of("M5 9H1V2H5z"), expected);
        for other in [
            "M1 2H5V9z",
            "M1 2H5L6 9H1z",
            "M1 2H5V9H1zM0 0h1v1z",
            "M1 2Q3 2 5 2V9H1z",
        ] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}
