//! Pictures of our own items by tiny-skia: for mips, for backdrops and for `Mode::Raster`.
//!
//! Painting the items rather than the SVG makes mips agree with the shapes by construction,
//! colour replacements included.

use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use rayon::prelude::*;
use tiny_skia::{
    Color, FillRule as SkiaFillRule, Paint, Path, PathBuilder, Pixmap, PixmapMut, PixmapPaint,
    Transform,
};
use vtex_format::Image;

use crate::color;
use crate::drawing::{FillRule, Item, Patch, Shape};
use crate::mips::{self, LinearImage};
use crate::palette;
use crate::resample;

/// Rows painted by one task. A constant, so that the picture does not depend on thread counts.
const BAND_ROWS: u32 = 256;
/// Samples a texel side for mips. tiny-skia blends edges in sRGB-encoded space and lets the ground
/// through where two shapes abut; both errors shrink with the width of an edge texel.
/// 4 costs 200 ms for the Tiger at 512 texels on two cores, chain included.
const SUPERSAMPLING: u32 = 4;
/// Texels a side of a supersampled picture.
const MAX_PICTURE_SIDE: u32 = 8192;

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

    /// The band of `rows` rows with an index.
    fn band(self, index: u32, rows: u32) -> Self {
        let top = index * rows;
        Self {
            size: [self.size[0], rows.min(self.size[1] - top)],
            origin: [self.origin[0], self.origin[1] + f64::from(top)],
            ..self
        }
    }
}

/// Texels of the canvas when its longer side gets `longer_side`: aspect kept, at least 1.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 1 and `longer_side`"
)]
pub(crate) fn canvas_texels(canvas_size: [f64; 2], longer_side: u32) -> [u32; 2] {
    let scale = f64::from(longer_side) / canvas_size[0].max(canvas_size[1]);
    canvas_size.map(|side| (side * scale).round().clamp(1.0, f64::from(longer_side)) as u32)
}

/// The mip chain of the whole canvas.
pub(crate) fn canvas_mips(items: &[Item], canvas_size: [f64; 2], mip0_size: u32) -> Image {
    let size = canvas_texels(canvas_size, mip0_size);
    let samples = (MAX_PICTURE_SIDE / mip0_size).clamp(1, SUPERSAMPLING);
    let picture = supersampled_picture(items, canvas_size, size, samples);
    let mut image = mips::chain(picture, [0.0, 0.0, 1.0, 1.0]);
    // A raster may hold gradients, which steps of a few codes would turn into bands.
    if items.iter().all(|item| matches!(item, Item::Shape(_))) {
        image
            .mips
            .par_iter_mut()
            .for_each(|level| palette::join_near_colors(level));
    }
    image
}

/// The canvas on `size` texels, each the average of `samples` a side.
fn supersampled_picture(
    items: &[Item],
    canvas_size: [f64; 2],
    size: [u32; 2],
    samples: u32,
) -> LinearImage {
    let view = View::canvas(canvas_size, size.map(|side| side * samples));
    let rows = BAND_ROWS / samples * samples;
    let texels = (0..view.size[1].div_ceil(rows))
        .into_par_iter()
        .flat_map_iter(|index| {
            picture(items, view.band(index, rows))
                .map(|pixmap| block_averages(&pixmap, size[0], samples))
                .unwrap_or_default()
        })
        .collect();
    LinearImage { size, texels }
}

/// Averages of squares of `side` texels, `columns` of them in a row.
fn block_averages(pixmap: &Pixmap, columns: u32, side: u32) -> Vec<[f32; 4]> {
    let texels = pixmap.data().as_chunks::<4>().0;
    let (columns, side) = (columns as usize, side as usize);
    let weight = 1.0 / (side * side) as f32;
    let mut averages = Vec::with_capacity(texels.len() / (side * side));
    for rows in texels.chunks_exact(columns * side * side) {
        averages.extend((0..columns).map(|column| {
            let block = rows.chunks_exact(columns * side);
            let block = block.map(|row| &row[column * side..(column + 1) * side]);
            let first = rows[column * side];
            // Most squares have one colour.
            if block.clone().flatten().all(|texel| *texel == first) {
                return color::linear_from_skia(first);
            }
            let mut sum = [0.0; 4];
            for &texel in block.flatten() {
                let linear = color::linear_from_skia(texel);
                for (sum, linear) in sum.iter_mut().zip(linear) {
                    *sum += weight * linear;
                }
            }
            sum
        }));
    }
    averages
}

/// The items in linear light.
pub(crate) fn linear_picture(items: &[Item], view: View) -> LinearImage {
    let bands = view.size[1].div_ceil(BAND_ROWS);
    let texels = (0..bands)
        .into_par_iter()
        .flat_map_iter(|index| {
            let band = view.band(index, BAND_ROWS);
            picture(items, band)
                .map(|pixmap| linear_texels(&pixmap))
                .unwrap_or_default()
        })
        .collect();
    LinearImage {
        size: view.size,
        texels,
    }
}

fn linear_texels(pixmap: &Pixmap) -> Vec<[f32; 4]> {
    let texels = pixmap.data().as_chunks::<4>().0;
    texels
        .iter()
        .map(|&texel| color::linear_from_skia(texel))
        .collect()
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
    let [r, g, b, a] = shape.color;
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
