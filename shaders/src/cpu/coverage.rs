//! Twin of `vtex/coverage_edge.wgsl` and `vtex/coverage_outline.wgsl`.

use super::edge::edge;
use super::{Lookup, Sampler, ramp};
use crate::layout::filter;

/// Coverage of an entry.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covered {
    /// The entry's last item and what follows it.
    pub(super) item: [u32; 4],
    pub(super) next: u32,
    /// Of the shape, and of the ring around it where `outline` asks for it (\[SFG22\] eq. 2).
    pub(super) coverage: (f32, f32),
}

pub(super) fn coverage(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> Covered {
    let settings = &sampler.settings;
    let sharp = settings.filter == filter::POINT && !settings.outline;
    let edge = edge(sampler, first, lookup, sharp);
    let inner = ramp::coverage(sampler, edge.distance, lookup.width_cells);
    let ring = if settings.outline {
        let grown = edge.distance + settings.outline_width;
        let outer = ramp::coverage(sampler, grown, lookup.width_cells);
        (outer - inner).max(0.0)
    } else {
        0.0
    };
    Covered {
        item: edge.item,
        next: edge.next,
        coverage: (inner, ring),
    }
}
