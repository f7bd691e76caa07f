//! Twin of `vtex/composite_front.wgsl` and `vtex/composite_translucent.wgsl`.

use super::entry::entry;
use super::over::{opaque, over, over_encoded};
use super::{Lookup, Sampler, Value, color};
use crate::layout::{entry as layout, filter};
use vtex_format::MAX_ENTRIES_PER_CELL;

fn is_last(head: u32) -> bool {
    head & layout::LAST_BIT != 0
}

fn nth(first: u32, index: u32) -> u32 {
    first.wrapping_add(index * layout::WORDS)
}

/// All paints opaque, or a mask: front to back until nothing behind can show.
pub(super) fn front<V: Value>(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> V {
    let mut value = V::ZERO;
    let mut through = 1.0;
    for i in 0..MAX_ENTRIES_PER_CELL {
        let words = sampler.words(nth(first, i));
        let shown = entry::<V>(sampler, words, lookup);
        value = value.plus(shown.scaled(through));
        through *= 1.0 - shown.alpha();
        if through <= 0.0 || is_last(words[0]) {
            break;
        }
    }
    value
}

/// Front to back through the opaque entries before the first translucent one.
pub(super) fn translucent(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut value = [0.0; 4];
    let mut through = 1.0;
    for i in 0..MAX_ENTRIES_PER_CELL {
        let word = nth(first, i);
        let words = sampler.words(word);
        if !opaque(sampler, words[0]) {
            return value.plus(behind(sampler, word, lookup).scaled(through));
        }
        let shown: [f32; 4] = entry(sampler, words, lookup);
        value = value.plus(shown.scaled(through));
        through *= 1.0 - shown[3];
        if through <= 0.0 || is_last(words[0]) {
            break;
        }
    }
    value
}

fn behind(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    if sampler.settings.filter == filter::POINT {
        point(sampler, first, lookup)
    } else {
        ramp(sampler, first, lookup)
    }
}

/// Coverage is 0 or 1: front to back on sRGB-encoded values, until an opaque entry is hit.
fn point(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut value = [0.0; 4];
    let mut hit_count = 0;
    let mut hit = [0; 2];
    for i in 0..MAX_ENTRIES_PER_CELL {
        let words = sampler.words(nth(first, i));
        let shown = over_encoded(sampler, words, lookup);
        if shown[3] > 0.0 {
            value = value.plus(shown.scaled(1.0 - value[3]));
            hit_count += 1;
            hit = words;
        }
        if shown[3] >= 1.0 || is_last(words[0]) {
            break;
        }
    }
    if hit_count == 1 {
        return entry(sampler, hit, lookup);
    }
    color::decode_premultiplied(value)
}

/// Back to front: what a translucent paint makes of the colours behind it needs them first.
fn ramp(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut last = 0;
    while last + 1 < MAX_ENTRIES_PER_CELL && !is_last(sampler.word(nth(first, last))) {
        last += 1;
    }
    let entries = (0..=last).rev();
    entries.fold([0.0; 4], |behind, i| {
        over(sampler, sampler.words(nth(first, i)), lookup, behind)
    })
}
