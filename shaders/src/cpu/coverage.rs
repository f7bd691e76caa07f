//! Twin of `vtex/coverage_msdf.wgsl` and `vtex/coverage_outline.wgsl`.

use super::{Lookup, Sampler, msdf};
use crate::layout::entry;

/// Of the shape, and of the ring around it where `outline` asks for it (\[SFG22\] eq. 2).
pub(super) fn coverage(
    sampler: &Sampler<'_>,
    [head, tile]: [u32; 2],
    lookup: &Lookup,
) -> (f32, f32) {
    if head >> entry::KIND_SHIFT != entry::MSDF {
        return (1.0, 0.0);
    }
    let distance = msdf::distance(sampler, tile, lookup.q);
    let inner = msdf::coverage(sampler, distance, lookup.width_cells);
    if !sampler.settings.outline {
        return (inner, 0.0);
    }
    let grown = distance + sampler.settings.outline_width;
    let outer = msdf::coverage(sampler, grown, lookup.width_cells);
    (inner, (outer - inner).max(0.0))
}
