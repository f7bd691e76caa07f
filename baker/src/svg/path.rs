//! usvg's paths and transforms in kurbo's types.

use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use usvg::tiny_skia_path::{self, PathSegment};

/// The transform in f64.
pub(crate) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// The box of a transformed rectangle.
pub(crate) fn transformed_bounds(rect: usvg::Rect, transform: Affine) -> Rect {
    let [left, top, right, bottom] =
        [rect.left(), rect.top(), rect.right(), rect.bottom()].map(f64::from);
    transform.transform_rect_bbox(Rect::new(left, top, right, bottom))
}

fn point(p: tiny_skia_path::Point) -> Point {
    Point::new(f64::from(p.x), f64::from(p.y))
}

/// The same path, segment by segment.
pub(crate) fn bez_path(path: &tiny_skia_path::Path) -> BezPath {
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => PathEl::MoveTo(point(p)),
            PathSegment::LineTo(p) => PathEl::LineTo(point(p)),
            PathSegment::QuadTo(p1, p) => PathEl::QuadTo(point(p1), point(p)),
            PathSegment::CubicTo(p1, p2, p) => PathEl::CurveTo(point(p1), point(p2), point(p)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}

/// The path with every subpath closed, as filling does (SVG 2 sec. 13.4), and without subpaths of
/// one point.
pub(crate) fn close_subpaths(path: &BezPath) -> BezPath {
    let mut closed = BezPath::new();
    let mut open = false;
    let mut pending_move = None;
    for &el in path.elements() {
        match el {
            PathEl::MoveTo(p) => {
                if open {
                    closed.close_path();
                }
                open = false;
                pending_move = Some(p);
            }
            PathEl::ClosePath => {
                if open {
                    closed.close_path();
                }
                open = false;
            }
            _ => {
                // Emitted only now, so a move without drawing leaves nothing behind.
                if let Some(p) = pending_move.take() {
                    closed.move_to(p);
                }
                closed.push(el);
                open = true;
            }
        }
    }
    if open {
        closed.close_path();
    }
    closed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subpath_ends_closed() {
        let path = BezPath::from_svg("M0 0 H1 V1 M5 5 M2 2 h1 v1 z M9 9 z").unwrap();
        let expected = BezPath::from_svg("M0 0 L1 0 L1 1 Z M2 2 L3 2 L3 3 Z").unwrap();
        assert_eq!(close_subpaths(&path), expected);
    }
}
