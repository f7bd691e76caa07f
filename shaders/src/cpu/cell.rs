//! Twin of `vtex/cell.wgsl`, `vtex/cells_list.wgsl` and `vtex/picture_scopes.wgsl`.

use super::fill::fill;
use super::math::{clamp, to_u32};
use super::{Lookup, Sampler, Value};
use crate::layout::{cell, item};

/// The fine cell's word and the position inside the file's cell.
pub(super) fn find(sampler: &Sampler<'_>, lookup: &Lookup) -> (u32, [f32; 2]) {
    let s = &sampler.settings;
    let mut part = [0.0; 2];
    let mut q = [0.0; 2];
    for axis in 0..2 {
        let p = lookup.uv[axis] * s.scale[axis] + s.offset[axis];
        part[axis] = clamp((p * s.fine_per_cell).floor(), 0.0, s.fine_size[axis] - 1.0);
        q[axis] = p - (part[axis] * s.cell_per_fine).floor();
    }
    (word_at(sampler, part.map(to_u32)), q)
}

/// Word of a fine cell.
pub(super) fn word_at(sampler: &Sampler<'_>, [x, y]: [u32; 2]) -> u32 {
    let s = &sampler.settings;
    let index = y.wrapping_mul(to_u32(s.fine_size[0])).wrapping_add(x);
    sampler.word(s.cells.wrapping_add(index))
}

pub(super) fn cells<V: Value>(sampler: &Sampler<'_>, lookup: &Lookup) -> V {
    let (word, q) = find(sampler, lookup);
    shown(sampler, word, &Lookup { q, ..*lookup })
}

/// What a fine cell with `word` shows at `lookup.q`.
pub(super) fn shown<V: Value>(sampler: &Sampler<'_>, word: u32, lookup: &Lookup) -> V {
    let payload = word & cell::PAYLOAD_MASK;
    match word >> cell::TAG_SHIFT {
        cell::SOLID => fill(sampler, payload, lookup),
        cell::LIST => {
            let offset = payload.wrapping_mul(item::WORDS);
            let first = sampler.settings.items.wrapping_add(offset);
            V::composite(sampler, first, lookup)
        }
        cell::SCOPES => {
            let offset = payload.wrapping_mul(item::WORDS);
            let first = sampler.settings.items.wrapping_add(offset);
            V::scopes(sampler, first, lookup)
        }
        _ => V::ZERO,
    }
}
