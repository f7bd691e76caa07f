//! Twin of `vtex/cell.wgsl` and `vtex/cell_level.wgsl`: base cells, and blocks of finer ones.

use super::Sampler;
use super::cost::Observer;
use super::math::{clamp, to_u32};
use super::plane::Vec2;
use crate::layout::{cell, half, has_list, is_block};

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
    let word = base(sampler, p, observer);
    of_block(sampler, p, word, [depth(word), 0], observer)
}

/// The cell that `p` lies in, on the finest level on which no more than `2^most` lie along one of the
/// file's, or on the coarsest that its block has.
pub(super) fn level(
    sampler: &Sampler<'_>,
    p: Vec2,
    most: i32,
    observer: &mut impl Observer,
) -> Cell {
    let word = base(sampler, p, observer);
    let depth = depth(word);
    // Halvings of a cell of the file: levels have even numbers of them.
    let exponent = sampler.settings.base_per_cell.to_bits() >> cell::EXPONENT_SHIFT;
    let halved = exponent.cast_signed() - 127;
    let finest = halved + depth.cast_signed();
    let coarsest = (halved.max(0) + 1) & !1;
    let above = (finest - 1) & !1;
    if most >= finest || above < coarsest {
        return of_block(sampler, p, word, [depth, 0], observer);
    }
    let chosen = (most & !1).max(coarsest).min(above);
    let chosen_depth = (chosen - halved).cast_unsigned();
    // The block's cells, then its levels from fine to coarse: 16 + 256 + ... times the words of this one.
    let between = 0x1111_1111 & ((1_u32 << (2 * (above - chosen))) - 1);
    let skipped = (1 << (2 * depth)) + (between << (2 * chosen_depth + 4));
    of_block(sampler, p, word, [chosen_depth, skipped], observer)
}

/// The word of the base cell that `p` lies in.
fn base(sampler: &Sampler<'_>, p: Vec2, observer: &mut impl Observer) -> u32 {
    let s = &sampler.settings;
    let base = place(sampler, p).map(|at| to_u32(at * s.base_per_cell));
    let index = base[1]
        .wrapping_mul(to_u32(s.base_columns))
        .wrapping_add(base[0]);
    observer.cell();
    sampler.word(s.cells.wrapping_add(index))
}

/// Of a base cell's word: how deep its block is, or 0.
const fn depth(word: u32) -> u32 {
    if is_block(word) {
        word >> cell::DEPTH_SHIFT & cell::DEPTH_MASK
    } else {
        0
    }
}

/// The cell that `p` lies in, where its base cell has `word`: of the level of this depth, which begins
/// so many words behind the block's first.
fn of_block(
    sampler: &Sampler<'_>,
    p: Vec2,
    word: u32,
    [depth, skipped]: [u32; 2],
    observer: &mut impl Observer,
) -> Cell {
    let s = &sampler.settings;
    let per_cell = s
        .base_per_cell
        .to_bits()
        .wrapping_add(depth << cell::EXPONENT_SHIFT);
    let at = place(sampler, p).map(|at| (at * f32::from_bits(per_cell)).floor());
    let mut found = Cell { word, per_cell, at };
    if is_block(word) {
        let inside = at.map(|at| to_u32(at) & ((1 << depth) - 1));
        let index = (inside[1] << depth).wrapping_add(inside[0]);
        found.word = in_block(sampler, word, index.wrapping_add(skipped));
        observer.cell();
    }
    found
}

/// The word of a cell of a block.
fn in_block(sampler: &Sampler<'_>, block: u32, index: u32) -> u32 {
    let first = sampler
        .settings
        .cells
        .wrapping_add(block & cell::PLACE_MASK);
    if block & cell::NARROW_BIT == 0 {
        return sampler.word(first.wrapping_add(index));
    }
    let pair = sampler.word(first.wrapping_add(1).wrapping_add(index / 2));
    let half = pair >> ((index & 1) * half::BITS) & half::MASK;
    let word = half >> half::TAG_SHIFT << cell::TAG_SHIFT;
    let lists = if has_list(word) {
        sampler.word(first)
    } else {
        0
    };
    word | (half & half::PAYLOAD_MASK).wrapping_add(lists)
}

/// The corner of the file's cell that `p` lies in.
pub(super) fn corner(sampler: &Sampler<'_>, p: Vec2) -> Vec2 {
    place(sampler, p).map(f32::floor)
}

/// The place in the grid that is nearest to `p`.
fn place(sampler: &Sampler<'_>, p: Vec2) -> Vec2 {
    [0, 1].map(|i| clamp(p[i], 0.0, sampler.settings.last_place[i]))
}
