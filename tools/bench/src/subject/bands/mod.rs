//! A rival of our own making: a loop over outlines whose curves are sorted into bands, in the
//! manner of Slug (Lengyel, "GPU-Centered Font Rendering Directly from Glyph Outlines", JCGT 6(2),
//! 2017).
//!
//! There is no grid. A lookup tests the bounds of every shape, front to back, and in a shape it
//! goes through the curves of one horizontal and one vertical band.

mod outlines;
mod sorted;

use resvg::usvg;

use crate::timing::{Device, Kernel};
use outlines::Outline;
use sorted::Sorted;

/// Most shapes for which the loop is timed. A lookup tests the bounds of each, so that a drawing
/// with more would keep a card busy for seconds.
const MAX_SHAPES: usize = 8192;

/// A drawing as this rival holds it.
#[derive(Debug, Default)]
pub(crate) struct Bands {
    /// Left, top, right, bottom of each shape in uv; front to back.
    bounds: Vec<[f32; 4]>,
    /// One for each of the bounds.
    shapes: Vec<Record>,
    /// Per shape two words for each band, first the horizontal ones: where its list of curves
    /// starts and how long it is. Then the lists.
    words: Vec<u32>,
    /// Two points each. A curve is two points of its own and the first of the next.
    curves: Vec<[f32; 4]>,
    curve_count: usize,
    /// What of the drawing is not in it, or not as drawn.
    pub(crate) left_out: Vec<&'static str>,
}

/// A shape, as `wgsl/bands.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct Record {
    /// Linear light, premultiplied.
    color: [f32; 4],
    /// Horizontal and vertical bands.
    bands: [u32; 2],
    first_word: u32,
    even_odd: u32,
}

impl Bands {
    /// Packs the outlines of a drawing.
    pub(crate) fn of(tree: &usvg::Tree) -> Self {
        let (outlines, left_out) = outlines::outlines(tree);
        let mut bands = Self {
            left_out,
            ..Self::default()
        };
        outlines.iter().rev().for_each(|outline| bands.add(outline));
        bands
    }

    fn add(&mut self, outline: &Outline) {
        let first_curve = self.curves.len();
        let Some(sorted) = Sorted::new(outline, first_curve) else {
            return;
        };
        let first_word = self.words.len();
        let lists = first_word + 2 * sorted.lists.len();
        let mut starts = Vec::new();
        let mut list_words: Vec<u32> = Vec::new();
        for list in &sorted.lists {
            // Neighbours often hold the same curves.
            let same = list_words
                .windows(list.len().max(1))
                .position(|w| w == list);
            let at = same.unwrap_or(list_words.len());
            if same.is_none() {
                list_words.extend(list);
            }
            starts.extend([index(lists + at), index(list.len())]);
        }
        self.words.extend(starts);
        self.words.extend(list_words);
        self.bounds.push(sorted.bounds);
        self.shapes.push(Record {
            color: outline.color,
            bands: sorted.bands,
            first_word: index(first_word),
            even_odd: u32::from(outline.even_odd),
        });
        self.curves.extend(sorted.curves);
        self.curve_count += outline.contours.iter().map(Vec::len).sum::<usize>();
    }

    /// Shapes that it loops over.
    pub(crate) fn shape_count(&self) -> usize {
        self.shapes.len()
    }

    /// Lines and quadratics of all shapes.
    pub(crate) fn curve_count(&self) -> usize {
        self.curve_count
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.bounds)
            + size_of_val(&*self.shapes)
            + size_of_val(&*self.words)
            + size_of_val(&*self.curves)
    }

    /// The loop; `None` where there is nothing to draw or too much of it.
    pub(crate) fn kernel(&self, device: &Device) -> Option<Kernel> {
        let storage = |bytes: &[u8]| device.buffer(bytes, wgpu::BufferUsages::STORAGE);
        if self.shapes.is_empty() || self.shapes.len() > MAX_SHAPES {
            return None;
        }
        let buffers = [
            storage(bytemuck::cast_slice(&self.bounds)),
            storage(bytemuck::cast_slice(&self.shapes)),
            storage(bytemuck::cast_slice(&self.words)),
            storage(bytemuck::cast_slice(&self.curves)),
        ];
        let resources = buffers.each_ref().map(wgpu::Buffer::as_entire_binding);
        Some(device.kernel(include_str!("../../wgsl/bands.wgsl"), &resources))
    }
}

/// A drawing's counts are far below what 32 bits hold.
fn index(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}
