//! Embedded images: they keep their own texels instead of being painted into a patch.
//!
//! resvg interpolates between texels by cubics or takes the nearest; lookups interpolate linearly.
//! So a small image is first enlarged by resvg, and the texels of the result are stored. Others have
//! no more texels than in the SVG, and no more than the largest zoom shows.

use kurbo::{Affine, Rect};
use tiny_skia::Pixmap;
use usvg::{ImageKind, ImageRendering, Node};
use vtex_format::EMBEDDED_SOURCE;

use super::{
    density::PatchSettings,
    finish::Source,
    resvg::paint_node,
    shown::{Texels, shown_part},
};
use crate::{
    drawing::Item,
    number::floor_u32,
    raster::{detail, mips::LinearImage, texel},
    svg::{PlanItem, Subtree},
};

/// Texels of all embedded images of a file together: 32 MiB with their mips. Images beyond it
/// become patches.
const MAX_TEXELS: u64 = 6_291_456;
/// Texels that all embedded images of a file together may be enlarged to, 0.33 MiB with their mips.
const MAX_ENLARGED_TEXELS: u64 = 1 << 16;
/// Largest enlargement along each axis of an image that is smoothed.
const MAX_SMOOTH: u32 = 8;
/// Largest enlargement of an image that is not smoothed. The blur that linear lookups leave between
/// its texels is then a 16th of a texel wide.
const MAX_SHARP: u32 = 16;
/// How far from upright an image may be, as a share of its scale.
const UPRIGHT: f64 = 1e-6;

/// An image that keeps its own texels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Embedded {
    /// Its texels in the SVG.
    size: [u32; 2],
    /// Stored texels for each of them, along both axes.
    enlarged: u32,
    /// Whether it is mirrored along x, and along y.
    mirrored: [bool; 2],
}

impl Embedded {
    /// `None` for a subtree that is no raster image, and for an image that is rotated or skewed:
    /// the file's images are upright rectangles.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "sizes of images are whole numbers within limits that the parser has checked"
    )]
    fn of(subtree: &Subtree<'_>) -> Option<Self> {
        let Node::Image(image) = subtree.node else {
            return None;
        };
        if matches!(image.kind(), ImageKind::SVG(_)) {
            return None;
        }
        let [a, _, _, d, ..] = subtree.canvas_from_parent.as_coeffs();
        let size = [image.size().width(), image.size().height()];
        if !is_upright(subtree) || size.iter().any(|side| !(1.0..=32_768.0).contains(side)) {
            return None;
        }
        let size = size.map(|side| side as u32);
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let most = match image.rendering_mode() {
            ImageRendering::OptimizeSpeed
            | ImageRendering::CrispEdges
            | ImageRendering::Pixelated => MAX_SHARP,
            ImageRendering::OptimizeQuality
            | ImageRendering::Smooth
            | ImageRendering::HighQuality => MAX_SMOOTH,
        };
        // A small image may be enlarged a lot, one of 2^16 texels not at all.
        let enlarged = (MAX_ENLARGED_TEXELS / texels)
            .isqrt()
            .clamp(1, u64::from(most));
        Some(Self {
            size,
            enlarged: enlarged as u32,
            mirrored: [a < 0.0, d < 0.0],
        })
    }

    fn stored_size(self) -> [u32; 2] {
        self.size.map(|side| side * self.enlarged)
    }

    fn enlarged_at_most(self, most: u32) -> Self {
        Self {
            enlarged: self.enlarged.min(most),
            ..self
        }
    }

    fn texels(self) -> u64 {
        let [width, height] = self.stored_size().map(u64::from);
        width * height
    }

    /// The image at its place on the canvas. `None` when resvg could not paint it; no item when
    /// nothing of it shows.
    pub(super) fn picture(
        self,
        subtree: &Subtree<'_>,
        settings: PatchSettings,
    ) -> Option<Option<Item>> {
        let mut picture = self.painted(subtree)?;
        let [width, height] = self.size.map(f64::from);
        let placed = Rect::new(0.0, 0.0, width, height);
        let rect = subtree.canvas_from_parent.transform_rect_bbox(placed);
        // The enlargement may have added nothing that linear lookups do not show.
        if self.enlarged > 1 {
            picture = detail::fitted(picture);
        }
        let most = settings.most_texels(rect);
        if picture.size[0] > most[0] || picture.size[1] > most[1] {
            picture = picture.reduced([0, 1].map(|axis| picture.size[axis].min(most[axis])));
        }
        let source = Source {
            feature: EMBEDDED_SOURCE,
            element: &subtree.element,
        };
        let shown = shown(picture, rect, settings.canvas_rect());
        Some(shown.map(|(picture, rect)| settings.item(picture, rect, source)))
    }

    /// Its texels as they lie on the canvas.
    fn painted(self, subtree: &Subtree<'_>) -> Option<LinearImage> {
        let size = self.stored_size();
        let mut pixmap = Pixmap::new(size[0], size[1])?;
        let texel_from_image = Affine::scale(self.enlarged.into());
        paint_node(subtree.node, texel_from_image, &mut pixmap)?;
        let texels = pixmap.data().as_chunks::<4>().0;
        let mut picture = LinearImage {
            size,
            texels: texels.iter().map(|&t| texel::linear_from_skia(t)).collect(),
        };
        // resvg has painted it upright; the rectangle of an image cannot be mirrored, so its texels
        // are.
        picture.mirror(self.mirrored);
        Some(picture)
    }
}

/// The part of an image that shows, in whole texels, and where it lies: without transparent margins,
/// and without what lies beside the canvas if that is most of it. Less is kept, so that an image that
/// is used twice keeps the same texels.
fn shown(picture: LinearImage, rect: Rect, canvas: Rect) -> Option<(LinearImage, Rect)> {
    let width = picture.size[0] as usize;
    let mut part = shown_part(&picture.texels, width, |texel| texel[3] > 0.0)?;
    let visible = rect.intersect(canvas);
    if 2.0 * visible.area() < rect.area() {
        part = intersection(part, texels_of(visible, rect, picture.size))?;
    }
    let scale = [
        rect.width() / f64::from(picture.size[0]),
        rect.height() / f64::from(picture.size[1]),
    ];
    let place = |side: usize| {
        let start = [rect.x0, rect.y0][side % 2];
        // The far sides stay where they are to the last bit.
        let end = [rect.x1, rect.y1][side % 2];
        if part[side] == picture.size[side % 2] {
            end
        } else {
            start + f64::from(part[side]) * scale[side % 2]
        }
    };
    let [left, top, right, bottom] = [0, 1, 2, 3].map(place);
    Some((picture.part(part), Rect::new(left, top, right, bottom)))
}

/// The texels that `visible` meets, and one more on each side, of an image on `rect`.
fn texels_of(visible: Rect, rect: Rect, size: [u32; 2]) -> Texels {
    let texel = |place: f64, start: f64, length: f64, side: u32| {
        ((place - start) / length * f64::from(side)).clamp(0.0, f64::from(side))
    };
    let x = |place: f64| texel(place, rect.x0, rect.width(), size[0]);
    let y = |place: f64| texel(place, rect.y0, rect.height(), size[1]);
    let low = |texel: f64| floor_u32(texel).saturating_sub(1);
    let high = |texel: f64, side: u32| (floor_u32(texel.ceil()) + 1).min(side);
    [
        low(x(visible.x0)),
        low(y(visible.y0)),
        high(x(visible.x1), size[0]),
        high(y(visible.y1), size[1]),
    ]
}

fn intersection(a: Texels, b: Texels) -> Option<Texels> {
    let part = [
        a[0].max(b[0]),
        a[1].max(b[1]),
        a[2].min(b[2]),
        a[3].min(b[3]),
    ];
    (part[0] < part[2] && part[1] < part[3]).then_some(part)
}

/// Whether the image's axes are those of the canvas.
pub(super) fn is_upright(subtree: &Subtree<'_>) -> bool {
    let [a, b, c, d, ..] = subtree.canvas_from_parent.as_coeffs();
    let least = a.abs().min(d.abs());
    least > 0.0 && b.abs().max(c.abs()) <= UPRIGHT * least
}

/// For each item the embedded image, if it is one that keeps its texels.
pub(super) fn choose(items: &[PlanItem<'_>]) -> Vec<Option<Embedded>> {
    let image = |item: &PlanItem<'_>| match item {
        PlanItem::Raster(subtree) => Embedded::of(subtree),
        PlanItem::Shape(_) | PlanItem::Clip(_) => None,
    };
    let mut embedded: Vec<Option<Embedded>> = items.iter().map(image).collect();
    share_out(embedded.iter_mut());
    embedded
}

/// Bounds the enlargement of all images so that they fit the budget together. If even the images as
/// they are do not fit, the last ones become patches.
fn share_out<'a>(images: impl Iterator<Item = &'a mut Option<Embedded>>) {
    let mut images: Vec<&mut Option<Embedded>> = images.filter(|image| image.is_some()).collect();
    let total = |images: &[&mut Option<Embedded>], most: u32| -> u64 {
        let images = images.iter().flat_map(|image| image.iter());
        images
            .map(|image| image.enlarged_at_most(most).texels())
            .sum()
    };
    // First less enlargement for all.
    let mut most = MAX_SHARP;
    while most > 1 && total(&images, most) > MAX_ENLARGED_TEXELS {
        most -= 1;
    }
    // Then first come, first served, in document order.
    let mut left = MAX_TEXELS;
    for image in &mut images {
        let kept = image.map(|image| image.enlarged_at_most(most));
        let rest = kept.and_then(|kept| left.checked_sub(kept.texels()));
        **image = kept.filter(|_| rest.is_some());
        left = rest.unwrap_or(left);
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use tiny_skia::{Pixmap, PremultipliedColorU8};
    use vtex_shaders::{PackOptions, cpu, pack};

    use crate::{BakeConfig, Resources, bake};

    /// A checkered image of 6 x 4 texels, red above and blue below, as the `href` of an element.
    fn image(attributes: &str) -> String {
        let mut pixmap = Pixmap::new(6, 4).unwrap();
        for (index, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
            let (x, y) = (index % 6, index / 6);
            let (red, blue) = if y < 2 { (255, 0) } else { (0, 255) };
            let green = if (x + y) % 2 == 0 { 200 } else { 0 };
            *pixel = PremultipliedColorU8::from_rgba(red, green, blue, 255).unwrap();
        }
        let png = pixmap.encode_png().unwrap();
        let quoted = png.iter().fold(String::new(), |mut text, byte| {
            let _ = write!(text, "%{byte:02X}");
            text
        });
        format!("<image {attributes} href='data:image/png,{quoted}'/>")
    }

    fn baked(body: &str) -> vtex_format::VtexFile {
        let svg =
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
        // A turned image takes more than the budget, which is no question here.
        let config = BakeConfig {
            gpu_budget_bytes: u64::MAX,
            ..BakeConfig::default()
        };
        bake(svg.as_bytes(), &config, &Resources::default()).unwrap()
    }

    #[test]
    fn an_upright_image_keeps_its_texels_and_its_edges() {
        let body = image(
            "x='10' y='20' width='60' height='40' preserveAspectRatio='none' \
             image-rendering='optimizeSpeed'",
        );
        let file = baked(&body);
        assert!(
            file.provenance.as_ref().unwrap().warnings.is_empty(),
            "it is no patch"
        );
        let [_, image] = file.images.as_slice() else {
            panic!("the canvas and the image");
        };
        assert_eq!(image.size[0] * 4, image.size[1] * 6, "{:?}", image.size);
        assert_eq!(image.rect_uv, [0.1, 0.2, 0.7, 0.6]);
        let packed = pack(&file, &PackOptions::default());
        let at = |u: f32, v: f32| cpu::Sampler::new(&packed).sample([u, v], [0.0; 4]);
        assert_eq!(at(0.0999, 0.25), [0.0; 4]);
        // Within a tenth of a texel of its own edges every texel has one colour.
        for (place, [x, y]) in [(0.0, [0, 0]), (1e-4, [0, 0]), (0.05, [0, 3]), (0.5, [5, 2])] {
            let inside = |index: u8| 0.1 * (f32::from(index) + 0.1 + 0.8 * place);
            let seen = at(0.1 + inside(x), 0.2 + inside(y));
            let green = if (x + y) % 2 == 0 { 200.0 / 255.0 } else { 0.0 };
            let rgb = if y < 2 {
                [1.0, green, 0.0]
            } else {
                [0.0, green, 1.0]
            };
            let expected = cpu::color::decode(rgb);
            let near = seen.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3);
            assert!(near, "{x} {y}: {seen:?} {expected:?}");
        }
    }

    #[test]
    fn a_turned_image_is_a_patch() {
        let file = baked(&image("width='60' height='40' transform='rotate(10)'"));
        let warnings = &file.provenance.as_ref().unwrap().warnings;
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        let message = &warnings[0].message;
        assert!(
            message.ends_with("texels: it is rotated or skewed"),
            "{message}"
        );
        assert!(warnings[0].area > 0.1, "{warnings:?}");
    }

    #[test]
    fn a_mirrored_image_keeps_its_texels() {
        let upright = baked(&image("width='60' height='40'"));
        let places = "translate(100 100) scale(-1 -1)";
        let turned = baked(&image(&format!(
            "width='60' height='40' transform='{places}'"
        )));
        assert!(turned.provenance.as_ref().unwrap().warnings.is_empty());
        let [packed, mirrored] =
            [&upright, &turned].map(|file| pack(file, &PackOptions::default()));
        for (u, v) in [(0.07, 0.03), (0.21, 0.33), (0.55, 0.12), (0.59, 0.39)] {
            let seen = cpu::Sampler::new(&packed).sample([u, v], [0.0; 4]);
            let again = cpu::Sampler::new(&mirrored).sample([1.0 - u, 1.0 - v], [0.0; 4]);
            let near = seen.iter().zip(again).all(|(a, b)| (a - b).abs() < 2e-3);
            assert!(near, "{u} {v}: {seen:?} {again:?}");
        }
    }

    #[test]
    fn images_share_a_budget() {
        let image = |side: u32| super::Embedded {
            size: [side; 2],
            enlarged: 2,
            mirrored: [false; 2],
        };
        let shared = |side: u32, count: usize| {
            let mut images = vec![Some(image(side)); count];
            super::share_out(images.iter_mut());
            let enlarged = images.iter().map(|image| image.map(|image| image.enlarged));
            enlarged.collect::<Vec<_>>()
        };
        assert_eq!(shared(100, 1), [Some(2)]);
        assert_eq!(shared(100, 2), [Some(1); 2]);
        let most = [[Some(1); 6].as_slice(), &[None; 2]].concat();
        assert_eq!(shared(1000, 8), most);
    }
}
