//! Raster images with their mip chains: image 0 is the whole canvas (minification), the others
//! are patches of what is not vector.

use bytemuck::{Pod, Zeroable};

/// Most levels a chain may have: 32,768 texels a side.
pub const MAX_MIPS: u32 = 16;
/// Most texels along a side of an image, so that a chain has at most [`MAX_MIPS`] levels. A
/// larger image is malformed.
pub const MAX_IMAGE_SIDE: u32 = 1 << (MAX_MIPS - 1);

/// One raster image with its whole mip chain.
///
/// Level `k` has `max(1, width >> k)` by `max(1, height >> k)` texels, down to 1 x 1. A texel is
/// RGBA8: red, green and blue are linear light, premultiplied by alpha, then sRGB-encoded; alpha
/// is stored as it is. So hardware sRGB formats filter it correctly.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Left, top, right, bottom on the canvas, in uv.
    pub rect_uv: [f32; 4],
    /// Texels of level 0.
    pub size: [u32; 2],
    /// Level 0 first; each `4 * width * height` bytes, row by row from the top.
    pub mips: Vec<Vec<u8>>,
}

impl Image {
    /// Texels of level `level`: each side halved and rounded down, at least 1.
    pub fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
        size.map(|side| side.checked_shr(level).unwrap_or(0).max(1))
    }

    /// Levels of a full chain down to 1 x 1.
    pub fn level_count(size: [u32; 2]) -> u32 {
        // One more than the floor of the binary logarithm.
        u32::BITS - size[0].max(size[1]).max(1).leading_zeros()
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
    /// Zero.
    pub(crate) reserved: u32,
}

impl ImageRecord {
    /// The record of an image.
    pub(crate) fn of(image: &Image) -> Self {
        Self {
            rect_uv: image.rect_uv,
            size: image.size,
            level_count: Image::level_count(image.size),
            reserved: 0,
        }
    }

    /// The image, its levels still to come.
    pub(crate) fn without_levels(&self) -> Image {
        Image {
            rect_uv: self.rect_uv,
            size: self.size,
            mips: Vec::new(),
        }
    }
}
