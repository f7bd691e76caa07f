//! Twin of `vtex/samples_point.wgsl`: what a lookup samples, as bits of a mask.

use super::plane::Vec2;
use super::{Sampler, segment};
use crate::layout::cmd::{BASE_LEFT, BASE_RIGHT, EVEN_ODD_BIT};

/// The samples of a lookup as seen from one cell of the file. A walk speaks of them as bits of a
/// mask.
pub(super) trait Samples {
    /// The windings of all samples about one outline; the default is zero.
    type Winding: Copy + Default;
    /// Adds what a segment does to the windings.
    fn wind(&self, winding: &mut Self::Winding, command: [u32; 4]);
    /// The samples that an entry with this tag covers.
    fn filled(&self, winding: Self::Winding, tag: u32) -> u32;
    /// The samples in a box, in uv: its corner of least coordinates, then the other.
    fn within(&self, sampler: &Sampler<'_>, sides: [f32; 4]) -> u32;
    /// The mean of samples, in uv.
    fn uv(&self, mask: u32) -> Vec2;
    /// The place of one sample inside the file's cell.
    fn q(&self, index: u32) -> Vec2;
    /// The place of the lookup inside the file's cell.
    fn centre(&self) -> Vec2;
}

/// How far a box may reach beyond its sides, in uv: as much as rounding may take. Images that abut have
/// sides that are rounded each by itself.
const SLACK: f32 = 1.2e-7;

/// One sample at the lookup itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// After texture matrix and address mode.
    pub(super) uv: Vec2,
    /// Inside the file's cell, in \[0, 1\].
    pub(super) q: Vec2,
    /// In units of the cell's box.
    pub(super) p: Vec2,
}

impl Samples for Point {
    type Winding = i32;

    fn wind(&self, winding: &mut i32, command: [u32; 4]) {
        *winding += segment::winding(command, self.p);
    }

    fn filled(&self, winding: i32, tag: u32) -> u32 {
        let total = winding + base(tag);
        u32::from(if tag & EVEN_ODD_BIT != 0 {
            total & 1 != 0
        } else {
            total != 0
        })
    }

    fn within(&self, _: &Sampler<'_>, sides: [f32; 4]) -> u32 {
        let inside =
            |i: usize| self.uv[i] >= sides[i] - SLACK && self.uv[i] <= sides[i + 2] + SLACK;
        u32::from(inside(0) && inside(1))
    }

    fn uv(&self, _: u32) -> Vec2 {
        self.uv
    }

    fn q(&self, _: u32) -> Vec2 {
        self.q
    }

    fn centre(&self) -> Vec2 {
        self.q
    }
}

/// The winding that an entry's tag says its segments begin with.
pub(super) const fn base(tag: u32) -> i32 {
    (tag << BASE_LEFT).cast_signed() >> BASE_RIGHT
}
