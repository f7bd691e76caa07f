//! Points of the curve lattice and vectors between them. With `segment.rs` the twin of
//! `vtex/segment.wgsl`.

use super::math::to_f32;

pub(crate) type Vec2 = [f32; 2];

/// A packed point: x in the low half, y in the high half.
pub(crate) fn point(word: u32) -> Vec2 {
    [to_f32(word & 0xffff), to_f32(word >> 16)]
}

pub(crate) fn sub(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn cross(a: Vec2, b: Vec2) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}
