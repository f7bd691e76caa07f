//! The part of the canvas that a patch is painted on, as a rectangle of texels.

use kurbo::Rect;
use tiny_skia::Pixmap;

use super::{density::PatchSettings, skia::View};
use crate::{
    drawing::ImageItem,
    number::to_f32,
    raster::{
        detail,
        mips::{self, LinearImage},
        texel,
    },
};

/// Left, top, right, bottom; the last two are one past the last texel.
type Texels = [u32; 4];

/// A rectangle of texels on the canvas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Width and height of the canvas in user units.
    canvas_size: [f64; 2],
    /// Texels of the whole canvas, which they cover exactly.
    lattice: [u32; 2],
    /// Those of the window.
    texels: Texels,
}

/// Where a patch comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    /// Why it is not geometry.
    pub(super) feature: &'a str,
    /// `id` of the element, may be empty.
    pub(super) element: &'a str,
}

impl Window {
    /// Texels that `bounds` touches and one more all around, within the canvas.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the lattice"
    )]
    pub(super) fn new(bounds: Rect, lattice: [u32; 2], settings: PatchSettings) -> Self {
        let canvas_size = settings.canvas_size;
        let texel = |value: f64, axis: usize| value * f64::from(lattice[axis]) / canvas_size[axis];
        let low = |value: f64, axis: usize| {
            let last = f64::from(lattice[axis] - 1);
            (texel(value, axis).floor() - 1.0).clamp(0.0, last) as u32
        };
        let high = |value: f64, axis: usize| {
            let end = f64::from(lattice[axis]);
            (texel(value, axis).ceil() + 1.0).clamp(1.0, end) as u32
        };
        Self {
            canvas_size,
            lattice,
            texels: [
                low(bounds.x0, 0),
                low(bounds.y0, 1),
                high(bounds.x1, 0),
                high(bounds.y1, 1),
            ],
        }
    }

    /// The window for painting.
    pub(super) fn view(&self) -> View {
        let [left, top, right, bottom] = self.texels;
        View {
            size: [right - left, bottom - top],
            origin: [f64::from(left), f64::from(top)],
            ..View::canvas(self.canvas_size, self.lattice)
        }
    }

    /// The painted window as a patch that is no larger and no finer than it has to be; `None` when
    /// nothing shows.
    pub(super) fn patch(&self, mut pixmap: Pixmap, source: Source<'_>) -> Option<ImageItem> {
        self.clear_border(&mut pixmap);
        let shown = self.shown_part(&pixmap)?;
        // Soft content such as a blurred shadow gets fewer texels.
        let level0 = detail::fitted(self.cropped(&pixmap, shown));
        let uv = |side: usize| f64::from(shown[side]) / f64::from(self.lattice[side % 2]);
        let rect_uv = [0, 1, 2, 3].map(uv);
        let [left, top, right, bottom] = rect_uv;
        let [width, height] = self.canvas_size;
        Some(ImageItem {
            rect: Rect::new(left * width, top * height, right * width, bottom * height),
            image: mips::chain(level0, rect_uv.map(to_f32)),
            feature: source.feature.to_owned(),
            element: source.element.to_owned(),
        })
    }

    /// Clears the outermost texels except along the edges of the canvas. A lookup at the border of
    /// the patch interpolates with nothing, so it fades out, even if the bounds were too small.
    fn clear_border(&self, pixmap: &mut Pixmap) {
        let ([left, top, right, bottom], lattice) = (self.texels, self.lattice);
        let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
        let texels = pixmap.data_mut().as_chunks_mut::<4>().0;
        if top > 0 {
            texels[..width].fill([0; 4]);
        }
        if bottom < lattice[1] {
            texels[(height - 1) * width..].fill([0; 4]);
        }
        for row in texels.chunks_exact_mut(width) {
            if left > 0 {
                row[0] = [0; 4];
            }
            if right < lattice[0] {
                row[width - 1] = [0; 4];
            }
        }
    }

    /// The smallest part that shows everything, with a transparent border except along the edges of
    /// the canvas. `None` when nothing shows.
    fn shown_part(&self, pixmap: &Pixmap) -> Option<Texels> {
        let width = pixmap.width() as usize;
        let texels = pixmap.data().as_chunks::<4>().0;
        let shows = |texel: &[u8; 4]| texel[3] > 0;
        let mut columns: Option<(usize, usize)> = None;
        let mut rows: Option<(usize, usize)> = None;
        for (y, row) in texels.chunks_exact(width).enumerate() {
            let Some(first) = row.iter().position(shows) else {
                continue;
            };
            let last = row.iter().rposition(shows).unwrap_or(first);
            columns = Some(columns.map_or((first, last), |(a, b)| (a.min(first), b.max(last))));
            rows = Some(rows.map_or((y, y), |(a, _)| (a, y)));
        }
        let ((left, right), (top, bottom)) = (columns?, rows?);
        let texel =
            |offset: usize, axis: usize| self.texels[axis] + u32::try_from(offset).unwrap_or(0);
        Some([
            // One transparent texel more on each side, so that lookups fade out.
            texel(left, 0).saturating_sub(1),
            texel(top, 1).saturating_sub(1),
            (texel(right, 0) + 2).min(self.lattice[0]),
            (texel(bottom, 1) + 2).min(self.lattice[1]),
        ])
    }

    fn cropped(&self, pixmap: &Pixmap, shown: Texels) -> LinearImage {
        let size = [shown[2] - shown[0], shown[3] - shown[1]];
        let width = pixmap.width() as usize;
        let [left, top] = [0, 1].map(|axis| (shown[axis] - self.texels[axis]) as usize);
        let texels = pixmap.data().as_chunks::<4>().0;
        let rows = texels.chunks_exact(width).skip(top).take(size[1] as usize);
        let texels = rows
            .flat_map(|row| &row[left..left + size[0] as usize])
            .map(|&texel| texel::linear_from_skia(texel))
            .collect();
        LinearImage { size, texels }
    }
}
