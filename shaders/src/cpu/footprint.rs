//! Twin of `vtex/footprint.wgsl`: the filter region of a lookup.

use super::math::length;

#[derive(Clone, Copy, Debug)]
pub(super) struct Lookup {
    /// After texture matrix and address mode.
    pub(super) uv: [f32; 2],
    /// Full width of the filter region; 0 is a point.
    pub(super) width_cells: f32,
    /// Position inside the cell, in \[0, 1\].
    pub(super) q: [f32; 2],
}

pub(super) fn width_cells(scale: [f32; 2], axes: [f32; 4]) -> f32 {
    let first = length([scale[0] * axes[0], scale[1] * axes[1]]);
    let second = length([scale[0] * axes[2], scale[1] * axes[3]]);
    first.max(second)
}
