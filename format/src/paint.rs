//! What a shape is coloured with.

use bytemuck::{Pod, Zeroable};

/// [`PaintRecord::kind`] of a single colour. 1 and 2 are kept for linear and radial gradients.
pub const PAINT_SOLID: u32 = 0;

/// One paint, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PaintRecord {
    /// [`PAINT_SOLID`].
    pub kind: u32,
    /// Zero.
    pub flags: u32,
    /// Zero for a solid paint.
    pub data_first: u32,
    /// Zero for a solid paint.
    pub data_count: u32,
    /// Straight alpha, sRGB-encoded, each in \[0, 1\].
    pub color: [f32; 4],
}

impl PaintRecord {
    /// A single colour: straight alpha, sRGB-encoded.
    pub fn solid(color: [f32; 4]) -> Self {
        Self {
            kind: PAINT_SOLID,
            color,
            ..Self::zeroed()
        }
    }

    /// Whether nothing behind the paint shows.
    pub fn is_opaque(&self) -> bool {
        self.kind == PAINT_SOLID && self.color[3] >= 1.0
    }
}
