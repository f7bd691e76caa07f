//! Twin of `vtex/source_*.wgsl` and `vtex/encoded_*.wgsl`: colour of an entry.

use super::fill::fill;
use super::value::paint_first;
use super::{Lookup, Sampler, Value, color, image};
use crate::layout::{item, paint};

pub(super) fn source<V: Value>(sampler: &Sampler<'_>, head: u32, lookup: &Lookup) -> V {
    let index = head & item::INDEX_MASK;
    if head & item::KIND_MASK == item::IMAGE {
        return image::entry(sampler, index, lookup);
    }
    fill(sampler, index, lookup)
}

/// sRGB-encoded, premultiplied. `value` is the same colour in linear light.
pub(super) fn encoded(sampler: &Sampler<'_>, head: u32, value: [f32; 4]) -> [f32; 4] {
    if head & item::KIND_MASK == item::IMAGE {
        return color::encode_premultiplied(value);
    }
    let first = paint_first(sampler, head & item::INDEX_MASK);
    let [r, g, b, a] = sampler.word_float4(first.wrapping_add(paint::ENCODED));
    if a < 0.0 {
        return color::encode_premultiplied(value);
    }
    [r * a, g * a, b * a, a]
}
