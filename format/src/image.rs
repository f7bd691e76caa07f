//! Raster images with their mip chains: image 0 is the whole canvas (minification), the others
//! are patches of what is not vector.

/// Most levels a chain may have: 32,768 texels a side.
pub const MAX_MIPS: u32 = 16;

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
        u32::BITS - size[0].max(size[1]).max(1).leading_zeros()
    }
}
