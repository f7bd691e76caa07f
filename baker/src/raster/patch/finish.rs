//! From texels at a place to an item of the drawing.

use kurbo::{Rect, Shape as _};

use super::density::PatchSettings;
use crate::{
    drawing::{FillRule, ImageItem, Item, Paint, Shape, ShapeSource, color::encode},
    number::{floor_u32, to_f32},
    raster::{
        canvas::canvas_texels,
        mips::{self, LinearImage},
        texel,
    },
};

/// Levels beyond the coarsest that a lookup in the cells can ask for: it may be loaded without mips
/// of the canvas taking over where they usually do, and filters may want a level more.
const SPARE_LEVELS: u32 = 2;
/// Tolerance of a path of lines alone, which are exact.
const EXACT: f64 = 1.0;

/// Where a picture comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    /// Why it is not geometry.
    pub(super) feature: &'a str,
    /// `id` of the element, may be empty.
    pub(super) element: &'a str,
}

impl PatchSettings {
    /// The picture on the rectangle `rect` of the canvas: a shape where it has one colour.
    pub(super) fn item(self, picture: LinearImage, rect: Rect, source: Source<'_>) -> Item {
        match flat_color(&picture) {
            Some(color) => Item::Shape(Shape {
                outline: rect.to_path(EXACT),
                fill_rule: FillRule::NonZero,
                paint: Paint::Solid(color),
                source: ShapeSource::Fill,
                element: source.element.to_owned(),
            }),
            None => Item::Image(self.image(picture, rect, source)),
        }
    }

    /// The picture as an image.
    pub(super) fn image(self, picture: LinearImage, rect: Rect, source: Source<'_>) -> ImageItem {
        let [width, height] = self.canvas_size;
        let rect_uv = [
            rect.x0 / width,
            rect.y0 / height,
            rect.x1 / width,
            rect.y1 / height,
        ];
        let levels = self.levels(picture.size, rect);
        ImageItem {
            rect,
            image: mips::chain(picture, rect_uv.map(to_f32), levels),
            feature: source.feature.to_owned(),
            element: source.element.to_owned(),
        }
    }

    /// How many levels lookups can ask for before the mips of the canvas stand for the cells, and
    /// [`SPARE_LEVELS`] more.
    fn levels(self, size: [u32; 2], rect: Rect) -> u32 {
        let canvas = canvas_texels(self.canvas_size, self.mip0_size);
        let shares = [
            rect.width() / self.canvas_size[0],
            rect.height() / self.canvas_size[1],
        ];
        let finer = |axis: usize| {
            f64::from(size[axis]) / (shares[axis] * f64::from(canvas[axis])).max(f64::MIN_POSITIVE)
        };
        let octaves = finer(0).max(finer(1)).max(1.0).log2().ceil();
        floor_u32(octaves).saturating_add(1 + SPARE_LEVELS)
    }
}

/// The straight, sRGB-encoded colour of a picture that has one.
fn flat_color(picture: &LinearImage) -> Option<[f32; 4]> {
    let stored = |texel: &[f32; 4]| texel::stored_from_linear(*texel);
    let first = picture.texels.first()?;
    let flat = picture
        .texels
        .iter()
        .all(|texel| stored(texel) == stored(first));
    let [r, g, b, a] = *first;
    (flat && a > 0.0).then(|| {
        let [r, g, b] = [r, g, b].map(|channel| encode((channel / a).clamp(0.0, 1.0)));
        [r, g, b, a]
    })
}
