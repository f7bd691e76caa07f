//! Twin of `vtex/entry_shape.wgsl` and `vtex/entry_outline.wgsl`.

use super::coverage::{Covered, coverage};
use super::source::source;
use super::{Lookup, Sampler, Value};

/// One entry of a list and its outline at a lookup.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<V> {
    /// The last word of its last item, and what follows the item.
    pub(super) head: u32,
    pub(super) next: u32,
    /// Of the shape and of the ring.
    pub(super) coverage: (f32, f32),
    /// Their colours, 0 where they do not cover.
    pub(super) value: V,
    pub(super) ring: V,
}

impl<V: Value> Entry<V> {
    pub(super) fn new(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> Self {
        Self::of(sampler, &coverage(sampler, first, lookup), lookup)
    }

    /// Of an entry that draws.
    pub(super) fn of(sampler: &Sampler<'_>, covered: &Covered, lookup: &Lookup) -> Self {
        let mut entry = Self {
            head: covered.item[3],
            next: covered.next,
            coverage: covered.coverage,
            value: V::ZERO,
            ring: V::ZERO,
        };
        if entry.coverage.0 > 0.0 {
            entry.value = source(sampler, entry.head, lookup);
        }
        if entry.coverage.1 > 0.0 {
            entry.ring = V::solid(sampler, sampler.settings.outline_paint);
        }
        entry
    }

    pub(super) fn coverage(&self) -> f32 {
        self.coverage.0 + self.coverage.1
    }

    /// What shows where nothing lies before or behind.
    pub(super) fn shown(&self) -> V {
        let shape = self.value.scaled(self.coverage.0);
        if self.coverage.1 > 0.0 {
            shape.plus(self.ring.scaled(self.coverage.1))
        } else {
            shape
        }
    }
}
