//! Twin of `vtex/edge_msdf.wgsl`, `vtex/edge_curves.wgsl` and `vtex/edge_any.wgsl`.

use super::{Sampler, curve, msdf};
use crate::layout::entry;

/// In texels, inside positive; only the sign is right when `sharp`. `None` when the entry has no
/// edge in its cell.
pub(super) fn distance(
    sampler: &Sampler<'_>,
    [head, data]: [u32; 2],
    q: [f32; 2],
    sharp: bool,
) -> Option<f32> {
    match head >> entry::KIND_SHIFT {
        entry::MSDF => Some(msdf::distance(sampler, data, q)),
        entry::CURVES => Some(curve::texels(sampler, data, q, sharp)),
        _ => None,
    }
}
