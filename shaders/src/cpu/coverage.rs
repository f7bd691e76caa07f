//! Twin of `vtex/coverage_edge.wgsl` and `vtex/coverage_outline.wgsl`.

use super::{Lookup, Sampler, edge, ramp};
use crate::layout::filter;

/// Of the shape, and of the ring around it where `outline` asks for it (\[SFG22\] eq. 2).
pub(super) fn coverage(sampler: &Sampler<'_>, entry: [u32; 2], lookup: &Lookup) -> (f32, f32) {
    let settings = &sampler.settings;
    let sharp = settings.filter == filter::POINT && !settings.outline;
    let Some(distance) = edge::distance(sampler, entry, lookup.q, sharp) else {
        return (1.0, 0.0);
    };
    let inner = ramp::coverage(sampler, distance, lookup.width_cells);
    if !settings.outline {
        return (inner, 0.0);
    }
    let grown = distance + settings.outline_width;
    let outer = ramp::coverage(sampler, grown, lookup.width_cells);
    (inner, (outer - inner).max(0.0))
}
