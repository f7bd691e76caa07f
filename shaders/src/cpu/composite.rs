//! Twin of `vtex/composite_front.wgsl` and `vtex/composite_translucent.wgsl`.

use super::entry::Entry;
use super::over::{opaque, over, over_encoded};
use super::{Lookup, Sampler, Value, color};
use crate::layout::{entry, filter};
use vtex_format::MAX_ENTRIES_PER_CELL;

fn is_last(head: u32) -> bool {
    head & entry::LAST_BIT != 0
}

/// All paints opaque, or a mask: front to back until nothing behind can show.
pub(super) fn front<V: Value>(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> V {
    let mut value = V::ZERO;
    let mut through = 1.0;
    for i in 0..MAX_ENTRIES_PER_CELL {
        let words = sampler.words(first.wrapping_add(i * entry::WORDS));
        let shown = Entry::<V>::new(sampler, words, lookup).shown();
        value = value.plus(shown.scaled(through));
        through *= 1.0 - shown.alpha();
        if through <= 0.0 || is_last(words[0]) {
            break;
        }
    }
    value
}

fn last(sampler: &Sampler<'_>, first: u32) -> u32 {
    let mut word = first;
    for _ in 1..MAX_ENTRIES_PER_CELL {
        if is_last(sampler.word(word)) {
            break;
        }
        word = word.wrapping_add(entry::WORDS);
    }
    word
}

/// With translucent paints. The WGSL walks both ways in one loop to be compiled small; here the
/// two directions are two functions.
pub(super) fn translucent(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let ramp = sampler.settings.filter != filter::POINT;
    let mut front = [0.0; 4];
    let mut through = 1.0;
    let mut color = [0.0; 4];
    let mut hit_count = 0;
    let mut word = first;
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let words = sampler.words(word);
        let opaque = opaque(sampler, words[0]);
        if ramp && !opaque {
            return front.plus(behind(sampler, word, lookup).scaled(through));
        }
        let entry = Entry::<[f32; 4]>::new(sampler, words, lookup);
        let shown = entry.shown();
        if opaque && hit_count == 0 {
            front = front.plus(shown.scaled(through));
            through *= 1.0 - shown[3];
        } else if shown[3] > 0.0 {
            front = shown;
            hit_count += 1;
            color = color.plus(over_encoded(sampler, &entry).scaled(1.0 - color[3]));
            through = 1.0 - color[3];
        }
        if through <= 0.0 || is_last(words[0]) {
            break;
        }
        word = word.wrapping_add(entry::WORDS);
    }
    if hit_count > 1 {
        color::decode_premultiplied(color)
    } else {
        front
    }
}

/// Back to front: what a translucent paint makes of the colours behind it needs them first.
fn behind(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut color = [0.0; 4];
    let mut word = last(sampler, first);
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let entry = Entry::new(sampler, sampler.words(word), lookup);
        if entry.coverage() > 0.0 {
            color = over(sampler, &entry, color);
        }
        if word == first {
            break;
        }
        word = word.wrapping_sub(entry::WORDS);
    }
    color
}
