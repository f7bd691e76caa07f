//! Raster images with their mip chains: image 0 is the whole canvas (minification), the others
//! are patches of what is not vector.

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

/// Most levels a chain may have: 32,768 texels a side.
pub const MAX_MIPS: u32 = 16;
/// Most texels along a side of an image, so that a chain has at most [`MAX_MIPS`] levels. A
/// larger image is malformed.
pub const MAX_IMAGE_SIDE: u32 = 1 << (MAX_MIPS - 1);

/// One raster image with its mip chain.
///
/// Level `k` has [`Image::level_size`] texels: its texel `i` stands for the texels `i << k` to
/// `(i + 1 << k) - 1` of level 0, as far as there are that many. The canvas has all levels down to
/// 1 x 1; another image may end earlier. A texel is RGBA8: red, green and blue are linear light,
/// premultiplied by alpha, then sRGB-encoded; alpha is stored as it is. So hardware sRGB formats
/// filter it correctly.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Left, top, right, bottom on the canvas, in uv.
    pub rect_uv: [f32; 4],
    /// Texels of level 0.
    pub size: [u32; 2],
    /// Level 0 first; each `4 * width * height` bytes, row by row from the top. A file stores equal
    /// texels of several images once, and a reader makes one `Arc` of them.
    pub mips: Arc<Vec<Vec<u8>>>,
}

impl Image {
    /// Texels of level `level`: each side divided by `2^level` and rounded up, at least 1.
    pub fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
        size.map(|side| side.saturating_sub(1).checked_shr(level).unwrap_or(0) + 1)
    }

    /// Levels of a full chain down to 1 x 1.
    pub fn level_count(size: [u32; 2]) -> u32 {
        // One more than the binary logarithm, rounded up.
        u32::BITS + 1 - (size[0].max(size[1]).max(1) - 1).leading_zeros()
    }

    /// Bytes of one level.
    pub(crate) fn level_bytes(size: [u32; 2], level: u32) -> u64 {
        let [width, height] = Self::level_size(size, level).map(u64::from);
        4 * width * height
    }

    /// Whether every texel of level 0 hides what lies behind it.
    pub(crate) fn is_opaque(&self) -> bool {
        self.mips.first().is_some_and(|texels| {
            let (texels, _) = texels.as_chunks::<4>();
            texels.iter().all(|texel| texel[3] == u8::MAX)
        })
    }
}

/// An image as `IMAG` stores it, 32 bytes; its levels are `MIPS` sections.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct ImageRecord {
    /// As [`Image::rect_uv`].
    pub(crate) rect_uv: [f32; 4],
    /// As [`Image::size`].
    pub(crate) size: [u32; 2],
    /// Number of levels.
    pub(crate) level_count: u32,
    /// Index of the image whose texels these are: its own, or that of an earlier image with texels of
    /// its own.
    pub(crate) texels_of: u32,
}

impl ImageRecord {
    /// The records of a file's images. Equal texels become shared.
    pub(crate) fn all(images: &[Image]) -> Vec<Self> {
        // By place in memory first: images of a file that was read share it, and comparing their
        // texels would take time that no budget bounds.
        let mut by_place = BTreeMap::new();
        let mut by_content = BTreeMap::new();
        let mut records = Vec::with_capacity(images.len());
        for (index, image) in images.iter().enumerate() {
            let content = || {
                *by_content
                    .entry((image.size, &*image.mips))
                    .or_insert(index)
            };
            let place = (image.size, Arc::as_ptr(&image.mips));
            let first = *by_place.entry(place).or_insert_with(content);
            records.push(Self {
                rect_uv: image.rect_uv,
                size: image.size,
                // A chain has at most `MAX_MIPS` levels; another number is refused.
                level_count: u32::try_from(image.mips.len()).unwrap_or(u32::MAX),
                texels_of: u32::try_from(first).unwrap_or(u32::MAX),
            });
        }
        records
    }

    /// The image with its levels.
    pub(crate) fn image(&self, mips: &Arc<Vec<Vec<u8>>>) -> Image {
        Image {
            rect_uv: self.rect_uv,
            size: self.size,
            mips: Arc::clone(mips),
        }
    }
}
