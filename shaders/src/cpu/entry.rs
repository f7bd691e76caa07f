//! Twin of `vtex/entry_shape.wgsl` and `vtex/entry_outline.wgsl`.

use super::coverage::coverage;
use super::source::source;
use super::{Lookup, Sampler, Value};

/// One entry of a list and its outline at a lookup.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<V> {
    pub(super) head: u32,
    /// Of the shape and of the ring.
    pub(super) coverage: (f32, f32),
    /// Their colours, 0 where they do not cover.
    pub(super) value: V,
    pub(super) ring: V,
}

impl<V: Value> Entry<V> {
    pub(super) fn new(sampler: &Sampler<'_>, words: [u32; 2], lookup: &Lookup) -> Self {
        let coverage = coverage(sampler, words, lookup);
        let mut entry = Self {
            head: words[0],
            coverage,
            value: V::ZERO,
            ring: V::ZERO,
        };
        if coverage.0 > 0.0 {
            entry.value = source(sampler, words[0], lookup);
        }
        if coverage.1 > 0.0 {
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
