//! The part of the canvas that a patch is painted on, as a rectangle of texels.

use kurbo::Rect;
use tiny_skia::Pixmap;

use super::{
    density::PatchSettings,
    shown::{Texels, shown_part},
    skia::View,
};
use crate::raster::{detail, mips::LinearImage, texel};

/// Codes by which neighbouring texels of soft pictures differ at most.
const MAX_SOFT: u8 = 4;
/// Texels of a patch that are too few to look for an end that is cut off.
const MIN_HARD_SIDE: u32 = 8;

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

    /// The part of the painted window that shows, no finer than it has to be, and where it lies; `None`
    /// when nothing shows.
    pub(super) fn picture(&self, mut pixmap: Pixmap) -> Option<(LinearImage, Rect)> {
        self.clear_border(&mut pixmap);
        let texels = pixmap.data().as_chunks::<4>().0;
        // Within the window there is a transparent border except along the edges of the canvas.
        let shown = shown_part(texels, pixmap.width() as usize, |texel| texel[3] > 0)?;
        let shown = without_border_of_hard_sides(&pixmap, shown);
        // Soft content such as a blurred shadow gets fewer texels.
        let picture = detail::fitted(cropped(&pixmap, shown));
        let place = |side: usize| {
            let axis = side % 2;
            let texel = f64::from(self.texels[axis] + shown[side]);
            texel / f64::from(self.lattice[axis]) * self.canvas_size[axis]
        };
        let [left, top, right, bottom] = [0, 1, 2, 3].map(place);
        Some((picture, Rect::new(left, top, right, bottom)))
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
}

/// The part without its transparent border along each side where the picture is cut off, as at the
/// end of a filter region: the rectangle of an image is an edge that needs no texels of its own, and
/// the border would keep a soft picture from being halved.
fn without_border_of_hard_sides(pixmap: &Pixmap, shown: Texels) -> Texels {
    let texels = pixmap.data().as_chunks::<4>().0;
    let width = pixmap.width() as usize;
    let mut part = shown;
    for side in 0..4 {
        let axis = side % 2;
        // From the border inwards.
        let line = |depth: u32| {
            let at = if side < 2 {
                shown[side] + depth
            } else {
                shown[side] - 1 - depth
            };
            let along = shown[1 - axis]..shown[3 - axis];
            along.map(move |place| {
                let [x, y] = if axis == 0 { [at, place] } else { [place, at] };
                texels[y as usize * width + x as usize]
            })
        };
        let has_border =
            shown[axis + 2] - shown[axis] > MIN_HARD_SIDE && line(0).all(|t| t[3] == 0);
        let differ =
            |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > MAX_SOFT);
        let cut_off = || line(1).any(|texel| texel[3] > MAX_SOFT);
        let soft_inside = || !line(1).zip(line(2)).any(|(a, b)| differ(a, b));
        if has_border && cut_off() && soft_inside() {
            part[side] = if side < 2 {
                shown[side] + 1
            } else {
                shown[side] - 1
            };
        }
    }
    part
}

fn cropped(pixmap: &Pixmap, shown: Texels) -> LinearImage {
    let [left, top, right, bottom] = shown;
    let texels = pixmap.data().as_chunks::<4>().0;
    let rows = texels.chunks_exact(pixmap.width() as usize);
    let rows = rows.skip(top as usize).take((bottom - top) as usize);
    let texels = rows
        .flat_map(|row| &row[left as usize..right as usize])
        .map(|&texel| texel::linear_from_skia(texel))
        .collect();
    LinearImage {
        size: [right - left, bottom - top],
        texels,
    }
}
