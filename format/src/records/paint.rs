//! What a shape is coloured with.

use bytemuck::{Pod, Zeroable};

use super::gradient::{FLAG_OPAQUE, GradientShape};

/// [`PaintRecord::kind`] of a single colour.
pub const PAINT_SOLID: u32 = 0;

/// One paint, 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PaintRecord {
    /// [`PAINT_SOLID`], or the kind of a gradient, from which [`crate::Gradient::of`] makes its shape.
    pub kind: u32,
    /// Zero for a solid paint; of a gradient the [`crate::Spread`] in bits 1..0, and bit 2 where it
    /// is opaque everywhere.
    pub flags: u32,
    /// First number in [`crate::VtexFile::gradients`]; zero for a solid paint.
    pub data_first: u32,
    /// How many numbers; zero for a solid paint.
    pub data_count: u32,
    /// Straight alpha, sRGB-encoded, each in \[0, 1\]; zeros for a gradient.
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

    /// Whether it is a gradient.
    pub fn is_gradient(&self) -> bool {
        GradientShape::has_kind(self.kind)
    }

    /// Whether nothing behind the paint shows, anywhere.
    pub fn is_opaque(&self) -> bool {
        match self.kind {
            PAINT_SOLID => self.color[3] >= 1.0,
            _ => self.flags & FLAG_OPAQUE != 0,
        }
    }
}
