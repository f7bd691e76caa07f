//! Pictures of single items by tiny-skia: of shapes that are too much for curves.

use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use tiny_skia::{
    Color, FillRule as SkiaFillRule, Paint, Path, PathBuilder, Pixmap, PixmapMut, PixmapPaint,
    Transform,
};

use crate::drawing::{self, FillRule, Item, Patch, Shape};
use crate::resample;

/// A window on the canvas, in texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Columns and rows.
    pub(crate) size: [u32; 2],
    /// Texels a user unit along x and y.
    pub(crate) scale: [f64; 2],
    /// Texel coordinates of the window's top-left corner.
    pub(crate) origin: [f64; 2],
}

impl View {
    /// The whole canvas on exactly `size` texels.
    pub(crate) fn canvas(canvas_size: [f64; 2], size: [u32; 2]) -> Self {
        let scale = [0, 1].map(|axis| f64::from(size[axis]) / canvas_size[axis]);
        Self {
            size,
            scale,
            origin: [0.0; 2],
        }
    }

    /// To texels of the window.
    pub(crate) fn texel_from_canvas(self) -> Affine {
        Affine::new([
            self.scale[0],
            0.0,
            0.0,
            self.scale[1],
            -self.origin[0],
            -self.origin[1],
        ])
    }
}

/// The items on a transparent ground; `None` when the window cannot be allocated.
pub(crate) fn picture(items: &[Item], view: View) -> Option<Pixmap> {
    let mut pixmap = Pixmap::new(view.size[0], view.size[1])?;
    paint(items, view, &mut pixmap.as_mut());
    Some(pixmap)
}

/// Paints the items over what is there.
pub(crate) fn paint(items: &[Item], view: View, pixmap: &mut PixmapMut<'_>) {
    let texel_from_canvas = view.texel_from_canvas();
    let window = Rect::new(0.0, 0.0, f64::from(view.size[0]), f64::from(view.size[1]));
    for item in items {
        match item {
            Item::Shape(shape) => paint_shape(shape, texel_from_canvas, window, pixmap),
            Item::Patch(patch) => paint_patch(patch, texel_from_canvas, window, pixmap),
            Item::Clip(_) => {}
        }
    }
}

fn misses(bounds: Rect, window: Rect) -> bool {
    bounds.x1 <= window.x0 - 1.0
        || bounds.x0 >= window.x1 + 1.0
        || bounds.y1 <= window.y0 - 1.0
        || bounds.y0 >= window.y1 + 1.0
}

fn paint_shape(shape: &Shape, transform: Affine, window: Rect, pixmap: &mut PixmapMut<'_>) {
    if misses(
        transform.transform_rect_bbox(shape.outline.control_box()),
        window,
    ) {
        return;
    }
    let Some(path) = skia_path(&shape.outline, transform) else {
        return;
    };
    let drawing::Paint::Solid([r, g, b, a]) = shape.paint;
    let Some(color) = Color::from_rgba(r, g, b, a) else {
        return;
    };
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    paint.set_color(color);
    let rule = match shape.fill_rule {
        FillRule::NonZero => SkiaFillRule::Winding,
        FillRule::EvenOdd => SkiaFillRule::EvenOdd,
    };
    pixmap.fill_path(&path, &paint, rule, Transform::identity(), None);
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

fn paint_patch(patch: &Patch, transform: Affine, window: Rect, pixmap: &mut PixmapMut<'_>) {
    let target = transform.transform_rect_bbox(patch.rect);
    if misses(target, window) {
        return;
    }
    let Some(part) = resample::patch_part(&patch.image, target, window) else {
        return;
    };
    let (x, y) = part.origin;
    let paint = PixmapPaint::default();
    pixmap.draw_pixmap(
        x,
        y,
        part.pixmap.as_ref(),
        &paint,
        Transform::identity(),
        None,
    );
}
