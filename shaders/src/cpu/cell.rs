//! Twin of `vtex/cell.wgsl`: base cells, and blocks of finer ones.

use super::Sampler;
use super::cost::Observer;
use super::math::{clamp, to_u32};
use super::plane::Vec2;
use crate::layout::cell;

/// A cell of the packed words.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Never that of a block.
    pub(super) word: u32,
    /// How many cells of this size lie along one of the file's, a power of two, as a float's bits.
    per_cell: u32,
    /// Its column and row among cells of this size.
    pub(super) at: Vec2,
}

impl Cell {
    /// How many cells of this size lie along one of the file's.
    pub(super) fn per_cell(&self) -> f32 {
        f32::from_bits(self.per_cell)
    }

    /// Its corners, in the file's cells.
    pub(super) fn ends(&self) -> [Vec2; 2] {
        [0.0, 1.0].map(|end| self.at.map(|at| (at + end) * self.side()))
    }

    /// The corners of the base cell that it lies in.
    pub(super) fn ends_of(&self, base_per_cell: f32) -> [Vec2; 2] {
        let base = self.at.map(|at| (at * self.side() * base_per_cell).floor());
        [0.0, 1.0].map(|end| base.map(|at| (at + end) / base_per_cell))
    }

    /// Its side, in the file's cells: exactly 1 / `per_cell`.
    pub(super) fn side(&self) -> f32 {
        f32::from_bits((254_u32 << cell::EXPONENT_SHIFT).wrapping_sub(self.per_cell))
    }
}

/// The cell that `p`, in the file's cells, lies in.
pub(super) fn cell(sampler: &Sampler<'_>, p: Vec2, observer: &mut impl Observer) -> Cell {
    let s = &sampler.settings;
    let place = [0, 1].map(|i| clamp(p[i], 0.0, s.last_place[i]));
    let base = place.map(|at| to_u32(at * s.base_per_cell));
    let index = base[1]
        .wrapping_mul(to_u32(s.base_columns))
        .wrapping_add(base[0]);
    let word = sampler.word(s.cells.wrapping_add(index));
    observer.cell();
    let divided = word >> cell::BLOCK_SHIFT == cell::BLOCK;
    let depth = if divided {
        word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK
    } else {
        0
    };
    let per_cell = s
        .base_per_cell
        .to_bits()
        .wrapping_add(depth << cell::EXPONENT_SHIFT);
    let at = place.map(|at| (at * f32::from_bits(per_cell)).floor());
    let mut found = Cell { word, per_cell, at };
    if divided {
        let inside = at.map(|at| to_u32(at) & ((1 << depth) - 1));
        let first = (word & cell::PLACE_MASK).wrapping_mul(cell::BLOCK_WORDS);
        let index = (inside[1] << depth).wrapping_add(inside[0]);
        found.word = sampler.word(s.cells.wrapping_add(first).wrapping_add(index));
        observer.cell();
    }
    found
}

/// The corner of the file's cell that `p` lies in.
pub(super) fn corner(sampler: &Sampler<'_>, p: Vec2) -> Vec2 {
    let s = &sampler.settings;
    [0, 1].map(|i| clamp(p[i], 0.0, s.last_place[i]).floor())
}
