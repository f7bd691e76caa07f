//! Twin of `vtex/edge_msdf.wgsl`, `vtex/edge_curves.wgsl` and `vtex/edge_any.wgsl`.

use super::run::{run, texels};
use super::{Lookup, Sampler, msdf};
use crate::layout::item;

/// The edge of an entry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The entry's last item and what follows it.
    pub(super) item: [u32; 4],
    pub(super) next: u32,
    /// In texels, inside positive; where the entry fills its cell, far inside. Of curves only the
    /// sign is right when `sharp`.
    pub(super) distance: f32,
}

pub(super) fn edge(sampler: &Sampler<'_>, first: u32, lookup: &Lookup, sharp: bool) -> Edge {
    let item: [u32; 4] = sampler.words(first);
    let whole = |distance| Edge {
        item,
        next: first.wrapping_add(item::WORDS),
        distance,
    };
    // Segments of curves carry no kind but in the last; one that ends its entry says what it is.
    if item[3] & item::END_BIT != 0 && item[3] & item::KIND_MASK != item::CURVES {
        return whole(match item[3] & item::KIND_MASK {
            item::MSDF => msdf::distance(sampler, item[0], lookup.q),
            _ => 1e9,
        });
    }
    let run = run(sampler, first, lookup.q, sharp);
    Edge {
        item: run.item,
        next: run.next,
        distance: texels(sampler, &run, sharp),
    }
}
