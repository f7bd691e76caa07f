//! Drawings for tests, from an SVG or made by hand.

use kurbo::{BezPath, PathEl};
use vtex_format::{Gradient, VtexFile};

use crate::{
    config::{BakeConfig, Resources},
    drawing::{Drawing, FillRule, Item, Paint, Shape, ShapeSource},
    number::to_f32,
    oracle::gradient,
};

/// A shape with a solid paint.
pub(crate) fn shape(outline: BezPath, fill_rule: FillRule, color: [f32; 4]) -> Item {
    Item::Shape(Shape {
        outline,
        fill_rule,
        paint: Paint::Solid(color),
        source: ShapeSource::Fill,
        element: String::new(),
    })
}

/// The colour of a solid paint.
pub(crate) fn solid(paint: &Paint) -> [f32; 4] {
    match paint {
        Paint::Solid(color) => *color,
        Paint::Gradient(gradient) => panic!("{gradient:?} is no single colour"),
    }
}

/// The colour of a paint at a uv, with straight alpha.
pub(crate) fn paint_at(paint: &Paint, uv: [f64; 2]) -> [f32; 4] {
    match paint {
        Paint::Solid(color) => *color,
        Paint::Gradient(gradient) => gradient::color_at(gradient, uv).map(to_f32),
    }
}

/// The colour of a file's paint at a uv, with straight alpha.
pub(crate) fn stored_at(file: &VtexFile, index: u32, uv: [f64; 2]) -> [f32; 4] {
    let record = &file.paints[index as usize];
    let stored = Gradient::of(record, &file.gradients);
    stored.map_or(record.color, |stored| {
        gradient::color_at(&stored, uv).map(to_f32)
    })
}

/// The drawing of an SVG, without fonts.
pub(crate) fn drawing_of(svg: &[u8], config: &BakeConfig) -> Drawing {
    crate::pipeline::draw(svg, config, &Resources::default(), &|_| ()).unwrap()
}

/// The outline with every contour closed.
pub(crate) fn closed(outline: &BezPath) -> BezPath {
    let mut out = BezPath::new();
    for element in outline.elements() {
        if matches!(element, PathEl::MoveTo(_)) && !out.elements().is_empty() {
            out.close_path();
        }
        out.push(*element);
    }
    if !out.elements().is_empty() {
        out.close_path();
    }
    out
}
