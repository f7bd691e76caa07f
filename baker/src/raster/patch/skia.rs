//! Painting a single shape by tiny-skia, for shapes that are too complex for curves.

use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use tiny_skia::{
    Color, FillRule as SkiaFillRule, GradientStop as SkiaStop, LinearGradient, Paint, Path,
    PathBuilder, Pixmap, Point as SkiaPoint, RadialGradient, Shader, SpreadMode, Transform,
};
use vtex_format::{Gradient, GradientShape, GradientStop, Spread};

use crate::drawing::{self, FillRule, Shape};

/// A window on the canvas, in texels.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Columns and rows.
    pub(super) size: [u32; 2],
    /// Texels along a user unit, along x and y.
    pub(super) scale: [f64; 2],
    /// Texel coordinates of the window's top-left corner.
    pub(super) origin: [f64; 2],
    /// Texels of the whole canvas.
    pub(super) canvas: [f64; 2],
}

impl View {
    /// The whole canvas on exactly `size` texels.
    pub(super) fn canvas(canvas_size: [f64; 2], size: [u32; 2]) -> Self {
        let scale = [0, 1].map(|axis| f64::from(size[axis]) / canvas_size[axis]);
        Self {
            size,
            scale,
            origin: [0.0; 2],
            canvas: size.map(f64::from),
        }
    }

    /// To texels of the window.
    pub(super) fn texel_from_canvas(self) -> Affine {
        Affine::new([
            self.scale[0],
            0.0,
            0.0,
            self.scale[1],
            -self.origin[0],
            -self.origin[1],
        ])
    }

    /// From uv of the canvas to texels of the window.
    fn texel_from_uv(self) -> Affine {
        let [x, y] = self.origin;
        Affine::translate((-x, -y)) * Affine::scale_non_uniform(self.canvas[0], self.canvas[1])
    }
}

/// The shape on a transparent ground; `None` when the window cannot be allocated.
pub(super) fn picture(shape: &Shape, view: View) -> Option<Pixmap> {
    let mut pixmap = Pixmap::new(view.size[0], view.size[1])?;
    paint_shape(shape, view, &mut pixmap);
    Some(pixmap)
}

/// Whether `bounds` lies beside the window by a texel or more.
fn misses(bounds: Rect, window: Rect) -> bool {
    bounds.x1 <= window.x0 - 1.0
        || bounds.x0 >= window.x1 + 1.0
        || bounds.y1 <= window.y0 - 1.0
        || bounds.y0 >= window.y1 + 1.0
}

fn paint_shape(shape: &Shape, view: View, pixmap: &mut Pixmap) {
    let window = Rect::new(0.0, 0.0, f64::from(view.size[0]), f64::from(view.size[1]));
    let transform = view.texel_from_canvas();
    if misses(
        transform.transform_rect_bbox(shape.outline.control_box()),
        window,
    ) {
        return;
    }
    let Some(path) = skia_path(&shape.outline, transform) else {
        return;
    };
    // Gradients are in uv, outlines in user units.
    let shader = match &shape.paint {
        drawing::Paint::Solid(color) => skia_color(*color).map(Shader::SolidColor),
        drawing::Paint::Gradient(it) => skia_gradient(it, view.texel_from_uv()),
    };
    let Some(shader) = shader else {
        return;
    };
    let paint = Paint {
        // As resvg paints.
        anti_alias: true,
        shader,
        ..Paint::default()
    };
    let rule = match shape.fill_rule {
        FillRule::NonZero => SkiaFillRule::Winding,
        FillRule::EvenOdd => SkiaFillRule::EvenOdd,
    };
    pixmap.fill_path(&path, &paint, rule, Transform::identity(), None);
}

fn skia_color([r, g, b, a]: [f32; 4]) -> Option<Color> {
    Color::from_rgba(r, g, b, a)
}

/// The gradient as a tiny-skia shader; `None` where tiny-skia cannot paint it.
fn skia_gradient(gradient: &Gradient, texel_from_uv: Affine) -> Option<Shader<'static>> {
    let stop = |stop: &GradientStop| Some(SkiaStop::new(stop.offset, skia_color(stop.color)?));
    let stops = gradient
        .stops
        .iter()
        .map(stop)
        .collect::<Option<Vec<_>>>()?;
    let mode = match gradient.spread {
        Spread::Pad => SpreadMode::Pad,
        Spread::Reflect => SpreadMode::Reflect,
        Spread::Repeat => SpreadMode::Repeat,
    };
    let from = |circle_from_uv: [f64; 6]| {
        skia_transform(texel_from_uv * Affine::new(circle_from_uv).inverse())
    };
    let point = SkiaPoint::from_xy;
    match gradient.shape {
        GradientShape::Linear { t_from_uv } => {
            let [a, b, c] = t_from_uv.map(f64::from);
            // t varies along one axis only; the other one is put at right angles to it in uv.
            let transform = from([a, -b, b, a, c, 0.0]);
            LinearGradient::new(point(0.0, 0.0), point(1.0, 0.0), stops, mode, transform)
        }
        GradientShape::Radial {
            circle_from_uv,
            distance,
            focal_radius,
        } => {
            let transform = from(circle_from_uv.map(f64::from));
            let (start, end) = (point(0.0, 0.0), point(distance, 0.0));
            RadialGradient::new(start, focal_radius, end, 1.0, stops, mode, transform)
        }
    }
}

/// A transform as tiny-skia has it.
#[expect(clippy::cast_possible_truncation, reason = "tiny-skia works in f32")]
pub(super) fn skia_transform(transform: Affine) -> Transform {
    let [a, b, c, d, e, f] = transform.as_coeffs().map(|x| x as f32);
    Transform::from_row(a, b, c, d, e, f)
}

#[expect(clippy::cast_possible_truncation, reason = "tiny-skia works in f32")]
fn skia_path(outline: &BezPath, transform: Affine) -> Option<Path> {
    let at = |p: Point| {
        let p = transform * p;
        (p.x as f32, p.y as f32)
    };
    let mut builder = PathBuilder::new();
    for el in outline.elements() {
        match *el {
            PathEl::MoveTo(p) => {
                let (x, y) = at(p);
                builder.move_to(x, y);
            }
            PathEl::LineTo(p) => {
                let (x, y) = at(p);
                builder.line_to(x, y);
            }
            PathEl::QuadTo(p1, p) => {
                let ((x1, y1), (x, y)) = (at(p1), at(p));
                builder.quad_to(x1, y1, x, y);
            }
            PathEl::CurveTo(p1, p2, p) => {
                let ((x1, y1), (x2, y2), (x, y)) = (at(p1), at(p2), at(p));
                builder.cubic_to(x1, y1, x2, y2, x, y);
            }
            PathEl::ClosePath => builder.close(),
        }
    }
    builder.finish()
}
