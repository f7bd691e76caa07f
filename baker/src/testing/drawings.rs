//! Drawings for tests: solid fills and plain strokes of an SVG, or by hand.

use std::path::PathBuf;

use kurbo::{Affine, BezPath, Point, Stroke, StrokeOpts};
use usvg::tiny_skia_path::PathSegment;

use crate::drawing::{Drawing, FillRule, Item, Shape, ShapeSource};

/// A file of the corpus; `None` when there is no corpus here.
pub(crate) fn corpus_file(name: &str) -> Option<Vec<u8>> {
    let root = std::env::var_os("VTEX_CORPUS").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/corpus"),
        PathBuf::from,
    );
    std::fs::read(root.join(name)).ok()
}

/// A shape by hand.
pub(crate) fn shape(outline: BezPath, fill_rule: FillRule, color: [f32; 4]) -> Item {
    Item::Shape(Shape {
        outline,
        fill_rule,
        color,
        source: ShapeSource::Fill,
        element: String::new(),
    })
}

/// Every solid fill and undashed stroke of an SVG without text.
pub(crate) fn drawing_of(svg: &[u8]) -> Drawing {
    let tree = usvg::Tree::from_data(svg, &usvg::Options::default()).unwrap();
    let mut items = Vec::new();
    walk(tree.root(), 1.0, &mut items);
    Drawing {
        canvas_size: [tree.size().width(), tree.size().height()].map(f64::from),
        items,
        warnings: Vec::new(),
    }
}

fn walk(group: &usvg::Group, opacity: f32, items: &mut Vec<Item>) {
    let opacity = opacity * group.opacity().get();
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => walk(group, opacity, items),
            usvg::Node::Path(path) => push_path(path, opacity, items),
            _ => {}
        }
    }
}

fn push_path(path: &usvg::Path, opacity: f32, items: &mut Vec<Item>) {
    let t = path.abs_transform();
    let transform = Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from));
    let outline = bez_path(path.data());
    let color = |paint: &usvg::Paint, alpha: f32| match paint {
        usvg::Paint::Color(c) => {
            let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0);
            Some([r, g, b, alpha * opacity])
        }
        _ => None,
    };
    if let Some(fill) = path.fill()
        && let Some(color) = color(fill.paint(), fill.opacity().get())
    {
        let rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        items.push(shape(transform * &outline, rule, color));
    }
    if let Some(stroke) = path.stroke()
        && let Some(color) = color(stroke.paint(), stroke.opacity().get())
    {
        let style = Stroke::new(f64::from(stroke.width().get()))
            .with_join(kurbo::Join::Miter)
            .with_caps(kurbo::Cap::Butt);
        let expanded = kurbo::stroke(&outline, &style, &StrokeOpts::default(), 1e-3);
        items.push(shape(transform * expanded, FillRule::NonZero, color));
    }
}

fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    let mut outline = BezPath::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => outline.move_to(point(p)),
            PathSegment::LineTo(p) => outline.line_to(point(p)),
            PathSegment::QuadTo(p, q) => outline.quad_to(point(p), point(q)),
            PathSegment::CubicTo(p, q, r) => outline.curve_to(point(p), point(q), point(r)),
            PathSegment::Close => outline.close_path(),
        }
    }
    outline
}
