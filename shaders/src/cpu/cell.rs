//! Twin of `vtex/cell.wgsl` and `vtex/cells_list.wgsl`.

use super::math::{clamp, to_f32, to_u32};
use super::{Lookup, Sampler, Value};
use crate::layout::cell;

fn find(sampler: &Sampler<'_>, lookup: &Lookup) -> (u32, [f32; 2]) {
    let s = &sampler.settings;
    let mut cell = [0; 2];
    let mut q = [0.0; 2];
    for axis in 0..2 {
        let p = lookup.uv[axis] * s.scale[axis] + s.offset[axis];
        let floor = clamp(p.floor(), 0.0, to_f32(s.grid_size[axis]) - 1.0);
        cell[axis] = to_u32(floor);
        q[axis] = p - floor;
    }
    let index = cell[1].wrapping_mul(s.grid_size[0]).wrapping_add(cell[0]);
    (sampler.word(s.cells.wrapping_add(index)), q)
}

pub(super) fn cells<V: Value>(sampler: &Sampler<'_>, lookup: &Lookup) -> V {
    let (word, q) = find(sampler, lookup);
    let payload = word & cell::PAYLOAD_MASK;
    match word >> cell::TAG_SHIFT {
        cell::SOLID => V::solid(sampler, payload),
        cell::LIST => {
            let first = sampler.settings.entries.wrapping_add(payload);
            V::composite(sampler, first, &Lookup { q, ..*lookup })
        }
        _ => V::ZERO,
    }
}
