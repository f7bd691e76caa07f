//! Twin of `vtex/over_paint.wgsl`, `vtex/over_shape.wgsl` and `vtex/over_outline.wgsl`.

use super::coverage::coverage;
use super::source::{encoded, source};
use super::{Lookup, Sampler, Value, color};
use crate::layout::entry;

/// decode(paint over encode(behind)); both sides linear light, premultiplied.
fn paint(sampler: &Sampler<'_>, head: u32, lookup: &Lookup, behind: [f32; 4]) -> [f32; 4] {
    if behind[3] <= 0.0 || head & entry::OPAQUE_BIT != 0 {
        return source(sampler, head, lookup);
    }
    let front = encoded(sampler, head, lookup);
    if front[3] <= 0.0 {
        return behind;
    }
    let back = color::encode_premultiplied(behind);
    color::decode_premultiplied(front.plus(back.scaled(1.0 - front[3])))
}

/// Whether `entry` says all there is to know of the entry's colour and its outline's.
pub(super) fn opaque(sampler: &Sampler<'_>, head: u32) -> bool {
    let outline = sampler.settings.outline_head.unwrap_or(entry::OPAQUE_BIT);
    head & outline & entry::OPAQUE_BIT != 0
}

/// Point mode: sRGB-encoded, premultiplied, 0 where neither shape nor outline covers.
pub(super) fn over_encoded(sampler: &Sampler<'_>, entry: [u32; 2], lookup: &Lookup) -> [f32; 4] {
    let (inner, ring) = coverage(sampler, entry, lookup);
    match sampler.settings.outline_head {
        _ if inner > 0.0 => encoded(sampler, entry[0], lookup),
        Some(head) if ring > 0.0 => encoded(sampler, head, lookup),
        _ => [0.0; 4],
    }
}

pub(super) fn over(
    sampler: &Sampler<'_>,
    entry: [u32; 2],
    lookup: &Lookup,
    behind: [f32; 4],
) -> [f32; 4] {
    let (inner, ring) = coverage(sampler, entry, lookup);
    if inner + ring <= 0.0 {
        return behind;
    }
    let mut value = behind.scaled(1.0 - inner - ring);
    if inner > 0.0 {
        value = value.plus(paint(sampler, entry[0], lookup, behind).scaled(inner));
    }
    if let (true, Some(head)) = (ring > 0.0, sampler.settings.outline_head) {
        value = value.plus(paint(sampler, head, lookup, behind).scaled(ring));
    }
    value
}
