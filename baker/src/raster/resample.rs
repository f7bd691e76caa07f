//! A patch brought to the texels of a picture: area average when it shrinks, bilinear when it
//! grows.

use kurbo::Rect;
use tiny_skia::Pixmap;
use vtex_format::Image;

use crate::{
    drawing::color,
    raster::mips::{Span, average, row_average},
};

/// Level texels that the box filter wants for a texel of the picture. With two, what the coarser
/// level has already averaged across a texel's rim no longer matters.
const BOX_OVERSAMPLING: f64 = 2.0;

/// The part of a patch that a picture shows, on the picture's texels.
#[derive(Debug)]
pub(crate) struct PatchPart {
    /// tiny-skia's texels.
    pub(crate) pixmap: Pixmap,
    /// Where its top-left texel lies in the picture.
    pub(crate) origin: (i32, i32),
}

/// The patch placed on `target`, cut to `window`; both in texels of the picture.
pub(crate) fn patch_part(image: &Image, target: Rect, window: Rect) -> Option<PatchPart> {
    let level = level_for(image, target);
    let size = Image::level_size(image.size, level);
    let columns = Axis::new(size[0], [target.x0, target.x1], [window.x0, window.x1])?;
    let rows = Axis::new(size[1], [target.y0, target.y1], [window.y0, window.y1])?;

    let width = size[0] as usize;
    let stored = image.mips.get(level as usize)?.as_chunks::<4>().0;
    let (first, last) = rows.touched()?;
    let texels: Vec<[f32; 4]> = stored
        .get(first * width..(last + 1) * width)?
        .iter()
        .map(|&texel| color::linear_from_stored(texel))
        .collect();

    let mut pixmap = Pixmap::new(columns.count()?, rows.count()?)?;
    let mut out = pixmap.data_mut().as_chunks_mut::<4>().0.iter_mut();
    for row in rows.spans {
        let sums = row_average(
            &texels,
            width,
            &Span {
                first: row.first - first,
                ..row
            },
        );
        for (column, texel) in columns.spans.iter().zip(&mut out) {
            *texel = color::skia_from_linear(average(&sums, column));
        }
    }
    Some(PatchPart {
        pixmap,
        origin: (columns.origin, rows.origin),
    })
}

/// The coarsest level that is still [`BOX_OVERSAMPLING`] times as fine as the picture.
fn level_for(image: &Image, target: Rect) -> u32 {
    let fine = |level: u32| {
        let size = Image::level_size(image.size, level);
        f64::from(size[0]) >= BOX_OVERSAMPLING * target.width()
            && f64::from(size[1]) >= BOX_OVERSAMPLING * target.height()
    };
    (1..Image::level_count(image.size))
        .take_while(|&level| fine(level))
        .last()
        .unwrap_or(0)
}

/// One axis of the resampling.
struct Axis {
    /// First texel of the picture.
    origin: i32,
    /// One span for each texel of the picture from there on; none is empty.
    spans: Vec<Span>,
}

impl Axis {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to the window, which fits"
    )]
    fn new(texels: u32, target: [f64; 2], window: [f64; 2]) -> Option<Self> {
        let first = target[0].max(window[0]).floor() as i32;
        let end = target[1].min(window[1]).ceil() as i32;
        let scale = f64::from(texels) / (target[1] - target[0]);
        if end <= first || !scale.is_finite() {
            return None;
        }
        let spans = (first..end).map(|texel| {
            let start = (f64::from(texel) - target[0]) * scale;
            if scale >= 1.0 {
                box_span(start, start + scale, texels)
            } else {
                tent_span(start + 0.5 * scale, texels)
            }
        });
        Some(Self {
            origin: first,
            spans: spans.collect(),
        })
    }

    fn count(&self) -> Option<u32> {
        u32::try_from(self.spans.len()).ok()
    }

    /// First and last image texel that any span reads.
    fn touched(&self) -> Option<(usize, usize)> {
        let first = self.spans.iter().map(|s| s.first).min()?;
        let last = self
            .spans
            .iter()
            .map(|s| s.first + s.weights.len().max(1) - 1)
            .max()?;
        Some((first, last))
    }
}

/// Weights of the texels in `[start, end]`; what lies outside the image counts as transparent.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the image; weights are shares in [0, 1]"
)]
fn box_span(start: f64, end: f64, texels: u32) -> Span {
    let count = f64::from(texels);
    let first = start.floor().clamp(0.0, count - 1.0);
    let last = (end.ceil() - 1.0).clamp(first, count - 1.0);
    let weights = (first as usize..=last as usize).map(|texel| {
        let overlap = end.min(texel as f64 + 1.0) - start.max(texel as f64);
        (overlap.max(0.0) / (end - start)) as f32
    });
    Span {
        first: first as usize,
        weights: weights.collect(),
    }
}

/// Bilinear weights at `center`, clamped to the image's rim as lookups are.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the image; weights are shares in [0, 1]"
)]
fn tent_span(center: f64, texels: u32) -> Span {
    let last = f64::from(texels) - 1.0;
    let at = (center - 0.5).clamp(0.0, last);
    let first = at.floor().min((last - 1.0).max(0.0));
    let share = (at - first) as f32;
    let weights = if texels == 1 {
        vec![1.0]
    } else {
        vec![1.0 - share, share]
    };
    Span {
        first: first as usize,
        weights,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_keep_the_area() {
        for (texels, target) in [(100, [3.3, 17.9]), (7, [-2.5, 900.25]), (64, [0.0, 64.0])] {
            let axis = Axis::new(texels, target, [-10.0, 1000.0]).unwrap();
            let weights = axis.spans.iter().flat_map(|s| &s.weights);
            let covered: f64 = weights.copied().map(f64::from).sum();
            let length = target[1] - target[0];
            assert!((covered - length).abs() < 2.0, "{covered} for {length}");
            assert!(axis.touched().unwrap().1 < texels as usize);
        }
    }

    #[test]
    fn the_same_size_copies() {
        let axis = Axis::new(9, [5.0, 14.0], [0.0, 100.0]).unwrap();
        for (texel, span) in axis.spans.iter().enumerate() {
            assert_eq!(
                (span.first, span.weights.as_slice()),
                (texel, [1.0].as_slice())
            );
        }
    }
}
