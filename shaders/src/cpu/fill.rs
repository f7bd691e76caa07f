//! Twin of `vtex/fill_*.wgsl`: what a paint shows at a lookup.

use super::gradient::gradient;
use super::value::paint_first;
use super::{Lookup, Sampler, Value};

pub(super) fn fill<V: Value>(sampler: &Sampler<'_>, index: u32, lookup: &Lookup) -> V {
    let solid = V::solid(sampler, index);
    if solid.alpha() >= 0.0 {
        return solid;
    }
    let first = sampler.word(paint_first(sampler, index));
    V::encoded(gradient(sampler, first, lookup.uv))
}

/// Whether a paint is no single colour.
pub(super) fn varies(sampler: &Sampler<'_>, index: u32) -> bool {
    <f32 as Value>::solid(sampler, index) < 0.0
}
