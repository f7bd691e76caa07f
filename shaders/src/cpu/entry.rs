//! Twin of `vtex/entry_shape.wgsl` and `vtex/entry_outline.wgsl`.

use super::coverage::coverage;
use super::source::source;
use super::{Lookup, Sampler, Value};

/// What an entry and its outline show where nothing lies before or behind them.
pub(super) fn entry<V: Value>(sampler: &Sampler<'_>, entry: [u32; 2], lookup: &Lookup) -> V {
    let (inner, ring) = coverage(sampler, entry, lookup);
    let mut value = V::ZERO;
    if inner > 0.0 {
        value = source::<V>(sampler, entry[0], lookup).scaled(inner);
    }
    if let (true, Some(head)) = (ring > 0.0, sampler.settings.outline_head) {
        value = value.plus(source::<V>(sampler, head, lookup).scaled(ring));
    }
    value
}
