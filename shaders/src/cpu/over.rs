//! Twin of `vtex/over_paint.wgsl`, `vtex/over_shape.wgsl` and `vtex/over_outline.wgsl`.

use super::entry::Entry;
use super::source::encoded;
use super::{Sampler, Value, color};
use crate::layout::item;

/// decode(paint over encode(behind)); `value` is the paint's colour.
fn paint(sampler: &Sampler<'_>, head: u32, value: [f32; 4], behind: [f32; 4]) -> [f32; 4] {
    if behind[3] <= 0.0 || head & item::OPAQUE_BIT != 0 {
        return value;
    }
    if value[3] <= 0.0 {
        return behind;
    }
    let front = encoded(sampler, head, value);
    let back = color::encode_premultiplied(behind);
    color::decode_premultiplied(front.plus(back.scaled(1.0 - front[3])))
}

/// Whether what lies behind shows in proportion to what the entry and its outline leave uncovered.
pub(super) fn opaque(sampler: &Sampler<'_>, head: u32) -> bool {
    head & sampler.settings.outline_head & item::OPAQUE_BIT != 0
}

/// Of an entry that covers, or its outline: sRGB-encoded, premultiplied.
pub(super) fn over_encoded(sampler: &Sampler<'_>, entry: &Entry<[f32; 4]>) -> [f32; 4] {
    if entry.coverage.0 > 0.0 {
        return encoded(sampler, entry.head, entry.value);
    }
    encoded(sampler, sampler.settings.outline_head, entry.ring)
}

/// Shape and ring cover different parts of the footprint: both lie over `behind`.
pub(super) fn over(sampler: &Sampler<'_>, entry: &Entry<[f32; 4]>, behind: [f32; 4]) -> [f32; 4] {
    let (inner, ring) = entry.coverage;
    let mut value = behind.scaled(1.0 - inner - ring);
    if inner > 0.0 {
        let shown = paint(sampler, entry.head, entry.value, behind);
        value = value.plus(shown.scaled(inner));
    }
    if ring > 0.0 {
        let shown = paint(sampler, sampler.settings.outline_head, entry.ring, behind);
        value = value.plus(shown.scaled(ring));
    }
    value
}
