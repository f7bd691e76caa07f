//! Drawings of paths in solid colours only, painted path by path with resvg's rasteriser.
//!
//! They look as resvg draws them, with two differences that matter at large zooms: [`strokes`]
//! expands strokes, and points are transformed to a tile's pixels in f64. In tiny-skia's f32 they
//! lose a quarter of a fine pixel at 256x.

use kurbo::{Affine, BezPath, Cap, Join, Point, Rect};
use resvg::tiny_skia::{self, Color, FillRule, Paint, PathBuilder, PixmapMut, Transform};

use super::strokes::{self, Piece, StrokeStyle};

/// Largest distance between a stroke and its pieces, in fine pixels.
const TOLERANCE_PX: f64 = 0.05;

/// What is painted, back to front.
#[derive(Debug)]
pub(crate) struct PlainPaths {
    paths: Vec<PlainPath>,
}

#[derive(Debug)]
struct PlainPath {
    path: BezPath,
    color: Color,
    part: Part,
    canvas_from_path: Affine,
}

#[derive(Debug)]
enum Part {
    Fill(FillRule),
    Stroke(StrokeStyle),
}

/// Outlines of one picture, in its fine pixels.
#[derive(Debug)]
pub(crate) struct Outlines {
    outlines: Vec<Outline>,
}

#[derive(Debug)]
struct Outline {
    color: Color,
    area: Area,
}

#[derive(Debug)]
enum Area {
    /// With its box.
    Path(BezPath, Rect, FillRule),
    /// Filled by the non-zero rule: one area.
    Pieces(Vec<Piece>),
}

impl PlainPaths {
    /// `None` when the tree holds anything else: effects, groups with opacity, other paints, images.
    pub(crate) fn new(tree: &usvg::Tree) -> Option<Self> {
        let mut paths = Vec::new();
        gather(tree.root(), Affine::IDENTITY, &mut paths)?;
        Some(Self { paths })
    }

    /// The outlines that reach into a picture of `size_px`.
    pub(crate) fn outlines(&self, px_from_canvas: Affine, size_px: [f64; 2]) -> Outlines {
        let window = Rect::new(0.0, 0.0, size_px[0], size_px[1]).inflate(1.0, 1.0);
        let outline = |plain: &PlainPath| Outline {
            color: plain.color,
            area: plain.area(px_from_canvas * plain.canvas_from_path, window),
        };
        Outlines {
            outlines: self.paths.iter().map(outline).collect(),
        }
    }
}

impl PlainPath {
    fn area(&self, px_from_path: Affine, window: Rect) -> Area {
        match &self.part {
            Part::Fill(rule) => {
                let path = px_from_path * &self.path;
                let bounds = path.control_box();
                Area::Path(path, bounds, *rule)
            }
            Part::Stroke(style) => {
                // The Frobenius norm: no vector is stretched by more, so the tolerance holds.
                let [a, b, c, d, _, _] = px_from_path.as_coeffs();
                let scale = (a * a + b * b + c * c + d * d).sqrt();
                if !(scale.is_finite() && scale > 0.0) {
                    return Area::Pieces(Vec::new());
                }
                let mut pieces = strokes::pieces(&self.path, style, TOLERANCE_PX / scale);
                for piece in &mut pieces {
                    piece.iter_mut().for_each(|p| *p = px_from_path * *p);
                }
                pieces.retain(|piece| meets(bounds(piece), window));
                Area::Pieces(pieces)
            }
        }
    }
}

/// The box of some points.
fn bounds(points: &[Point]) -> Rect {
    let first = points.first().copied().unwrap_or_default();
    let empty = Rect::from_points(first, first);
    points.iter().fold(empty, |bounds, &p| bounds.union_pt(p))
}

fn meets(a: Rect, b: Rect) -> bool {
    a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1
}

impl Outlines {
    /// Paints the tile whose corner is at `origin_px`, with hard edges.
    pub(crate) fn paint(&self, origin_px: [f64; 2], pixmap: &mut PixmapMut<'_>) {
        let corner = Point::new(origin_px[0], origin_px[1]);
        let size = (f64::from(pixmap.width()), f64::from(pixmap.height()));
        let tile = Rect::from_origin_size(corner, size).inflate(1.0, 1.0);
        for outline in &self.outlines {
            let Some((path, rule)) = outline.area.in_tile(tile, corner) else {
                continue;
            };
            let mut paint = Paint {
                anti_alias: false,
                ..Paint::default()
            };
            paint.set_color(outline.color);
            pixmap.fill_path(&path, &paint, rule, Transform::identity(), None);
        }
    }
}

impl Area {
    /// What of it reaches into `tile`, from `corner`.
    fn in_tile(&self, tile: Rect, corner: Point) -> Option<(tiny_skia::Path, FillRule)> {
        let mut builder = PathBuilder::new();
        let rule = match self {
            Self::Path(path, bounds, rule) => {
                if !meets(*bounds, tile) {
                    return None;
                }
                for element in path.elements() {
                    push(&mut builder, element, corner);
                }
                *rule
            }
            Self::Pieces(pieces) => {
                for piece in pieces.iter().filter(|piece| meets(bounds(piece), tile)) {
                    let path = BezPath::from_iter(polygon(piece));
                    for element in path.elements() {
                        push(&mut builder, element, corner);
                    }
                }
                FillRule::Winding
            }
        };
        Some((builder.finish()?, rule))
    }
}

fn polygon(piece: &[Point]) -> impl Iterator<Item = kurbo::PathEl> {
    let points = piece.iter().enumerate().map(|(index, &p)| match index {
        0 => kurbo::PathEl::MoveTo(p),
        _ => kurbo::PathEl::LineTo(p),
    });
    points.chain([kurbo::PathEl::ClosePath])
}

fn push(builder: &mut PathBuilder, element: &kurbo::PathEl, corner: Point) {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "tiny-skia's points are f32"
    )]
    let local = |p: Point| [(p.x - corner.x) as f32, (p.y - corner.y) as f32];
    match *element {
        kurbo::PathEl::MoveTo(p) => {
            let [x, y] = local(p);
            builder.move_to(x, y);
        }
        kurbo::PathEl::LineTo(p) => {
            let [x, y] = local(p);
            builder.line_to(x, y);
        }
        kurbo::PathEl::QuadTo(c, p) => {
            let [[cx, cy], [x, y]] = [c, p].map(local);
            builder.quad_to(cx, cy, x, y);
        }
        kurbo::PathEl::CurveTo(c, d, p) => {
            let [[cx, cy], [dx, dy], [x, y]] = [c, d, p].map(local);
            builder.cubic_to(cx, cy, dx, dy, x, y);
        }
        kurbo::PathEl::ClosePath => builder.close(),
    }
}

fn gather(
    group: &usvg::Group,
    canvas_from_parent: Affine,
    paths: &mut Vec<PlainPath>,
) -> Option<()> {
    let plain = group.opacity() == usvg::Opacity::ONE
        && group.blend_mode() == usvg::BlendMode::Normal
        && group.clip_path().is_none()
        && group.mask().is_none()
        && group.filters().is_empty();
    if !plain {
        return None;
    }
    let transform = canvas_from_parent * affine(group.transform());
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => gather(group, transform, paths)?,
            usvg::Node::Path(path) => gather_path(path, transform, paths)?,
            usvg::Node::Text(text) => gather(text.flattened(), transform, paths)?,
            usvg::Node::Image(_) => return None,
        }
    }
    Some(())
}

fn gather_path(
    path: &usvg::Path,
    canvas_from_path: Affine,
    paths: &mut Vec<PlainPath>,
) -> Option<()> {
    if !path.is_visible() {
        return Some(());
    }
    let plain = |part, color| PlainPath {
        path: bez_path(path.data()),
        color,
        part,
        canvas_from_path,
    };
    let bounds = path.data().bounds();
    let mut parts = Vec::new();
    if let Some(fill) = path.fill() {
        let rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::Winding,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        let color = solid(fill.paint(), fill.opacity())?;
        // resvg does not fill a path without area either.
        if bounds.width() > 0.0 && bounds.height() > 0.0 {
            parts.push(plain(Part::Fill(rule), color));
        }
    }
    if let Some(stroke) = path.stroke() {
        let color = solid(stroke.paint(), stroke.opacity())?;
        parts.push(plain(Part::Stroke(style(stroke)?), color));
    }
    if path.paint_order() == usvg::PaintOrder::StrokeAndFill {
        parts.reverse();
    }
    paths.extend(parts);
    Some(())
}

/// `None` for clipped miters, which are left to resvg.
fn style(stroke: &usvg::Stroke) -> Option<StrokeStyle> {
    let dashes = stroke.dasharray().unwrap_or_default();
    Some(StrokeStyle {
        radius: 0.5 * f64::from(stroke.width().get()),
        cap: match stroke.linecap() {
            usvg::LineCap::Butt => Cap::Butt,
            usvg::LineCap::Round => Cap::Round,
            usvg::LineCap::Square => Cap::Square,
        },
        join: match stroke.linejoin() {
            usvg::LineJoin::Miter => Join::Miter,
            usvg::LineJoin::MiterClip => return None,
            usvg::LineJoin::Round => Join::Round,
            usvg::LineJoin::Bevel => Join::Bevel,
        },
        miter_limit: f64::from(stroke.miterlimit().get()),
        dashes: dashes.iter().copied().map(f64::from).collect(),
        dash_offset: f64::from(stroke.dashoffset()),
    })
}

fn solid(paint: &usvg::Paint, opacity: usvg::Opacity) -> Option<Color> {
    let usvg::Paint::Color(color) = paint else {
        return None;
    };
    let mut color = Color::from_rgba8(color.red, color.green, color.blue, 255);
    color.set_alpha(opacity.get());
    Some(color)
}

fn affine(transform: Transform) -> Affine {
    let Transform {
        sx,
        kx,
        ky,
        sy,
        tx,
        ty,
    } = transform;
    Affine::new([sx, ky, kx, sy, tx, ty].map(f64::from))
}

fn bez_path(path: &tiny_skia::Path) -> BezPath {
    use tiny_skia::PathSegment;
    let point = |p: tiny_skia::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let element = |segment| match segment {
        PathSegment::MoveTo(p) => kurbo::PathEl::MoveTo(point(p)),
        PathSegment::LineTo(p) => kurbo::PathEl::LineTo(point(p)),
        PathSegment::QuadTo(c, p) => kurbo::PathEl::QuadTo(point(c), point(p)),
        PathSegment::CubicTo(c, d, p) => kurbo::PathEl::CurveTo(point(c), point(d), point(p)),
        PathSegment::Close => kurbo::PathEl::ClosePath,
    };
    path.segments().map(element).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::{Edges, Reference};
    use crate::picture::View;

    /// Coverage of a window.
    fn covered(content: &str, view: View) -> f64 {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{content}</svg>"
        );
        let reference = Reference::parse(svg.as_bytes(), Arc::default(), Edges::Crisp).unwrap();
        let picture = reference.render(view, [16, 16]).unwrap();
        picture
            .pixels
            .iter()
            .map(|pixel| f64::from(pixel[3]))
            .sum::<f64>()
            / 256.0
    }

    #[test]
    fn round_caps_are_round_at_any_zoom() {
        // Radius 2 about (50, 50); a window of a 2048th of the canvas about its edge is half
        // covered but for the arc's height, a 300th of the window.
        let cap = "<path d='M50 50H10' stroke='#000' stroke-width='4' stroke-linecap='round'/>";
        for degrees in [12.0_f64, 22.5, 40.0, 67.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let view = View::window([0.5 + 0.02 * cos, 0.5 + 0.02 * sin], 2048.0);
            let share = covered(cap, view);
            assert!((share - 0.5).abs() < 0.006, "{degrees}: {share}");
        }
    }

    #[test]
    fn strokes_have_no_holes() {
        // Turns all the way round, with a cap of each kind inside the line.
        for cap in ["round", "square", "butt"] {
            let content = format!(
                "<path d='M20 50a30 30 0 1 0 60 0a30 30 0 1 0 -60 0v.1' stroke='#000' fill='none' \
                 stroke-width='14' stroke-linecap='{cap}' stroke-linejoin='round'/>"
            );
            for degrees in [0.0_f64, 25.0, 50.0, 80.0, 145.0, 180.0, 250.0, 290.0, 345.0] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let view = View::window([0.5 + 0.3 * cos, 0.5 + 0.3 * sin], 12.0);
                let share = covered(&content, view);
                // One sample of 65,792 may fall between two bits at the end of a curve.
                assert!(share >= 0.9999, "{cap} at {degrees}: {share}");
            }
        }
    }

    #[test]
    fn strokes_are_as_resvg_draws_them() {
        let open = "d='M20 30L50 35L60 60C90 60 60 20 85 30' stroke='#000' fill='none'";
        // resvg leaves the start of a dashed closed path without its cap.
        let closed = &open.replace("85 30'", "85 30Z'");
        // The last handle is short: the miter's tip hangs on the direction of the very end.
        let turning = "d='M20 40C60 20 79.9 49.7 80 50L30 70' stroke='#000' fill='none'";
        for (line, style) in [
            (turning, "stroke-width='6' stroke-miterlimit='20'"),
            (closed.as_str(), "stroke-width='9'"),
            (
                closed.as_str(),
                "stroke-width='9' stroke-linejoin='round' transform='skewX(-20)'",
            ),
            (
                open,
                "stroke-width='6' stroke-linejoin='bevel' stroke-dasharray='7 3 2' stroke-dashoffset='4'",
            ),
            (
                open,
                "stroke-width='6' stroke-linecap='square' stroke-dasharray='9'",
            ),
            (
                open,
                "stroke-width='6' stroke-linecap='round' stroke-dasharray='11 9' stroke-dashoffset='-5'",
            ),
            (closed.as_str(), "stroke-width='8' stroke-miterlimit='1.1'"),
        ] {
            let content = format!("<path {line} {style}/>");
            // The opacity makes resvg draw it.
            let by_resvg = format!("<g opacity='.999'>{content}</g>");
            for [u, v] in [[0.25, 0.25], [0.5, 0.5], [0.75, 0.4], [0.3, 0.35]] {
                let view = View::window([u, v], 3.0);
                let [ours, theirs] = [&content, &by_resvg].map(|content| covered(content, view));
                let apart = (ours - theirs).abs();
                assert!(
                    apart < 4e-3 && ours > 0.02,
                    "{style} {view:?}: {ours} {theirs}"
                );
            }
        }
    }
}
