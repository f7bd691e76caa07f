//! Twin of `vtex/composite_front.wgsl`, `vtex/composite_point.wgsl` and `vtex/composite_ramp.wgsl`,
//! and of the list in `vtex/cells_first.wgsl`.

use super::coverage::{Covered, coverage};
use super::entry::Entry;
use super::flow;
use super::over::{opaque, over, over_encoded};
use super::{Lookup, Sampler, Value, color};
use crate::layout::filter;
use crate::layout::item::{CONTROL_BIT, END_BIT, LAST_BIT, LIMIT, WORDS};
use vtex_format::MAX_ENTRIES_PER_CELL;

/// All paints opaque, or a mask: front to back until nothing behind can show.
pub(super) fn front<V: Value>(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> V {
    let mut value = V::ZERO;
    let mut through = 1.0;
    let mut item = first;
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let covered = coverage(sampler, item, lookup);
        if covered.item[3] & CONTROL_BIT != 0 {
            item = passed(&covered);
            if sampler.is_past(item) {
                break;
            }
            continue;
        }
        let entry = Entry::<V>::of(sampler, &covered, lookup);
        let shown = entry.shown();
        item = entry.next;
        value = value.plus(shown.scaled(through));
        through *= 1.0 - shown.alpha();
        if through <= 0.0 || entry.head & LAST_BIT != 0 || sampler.is_past(entry.next) {
            break;
        }
    }
    value
}

/// Where a walk goes on behind a test. Twin of the jump in `vtex/clips.wgsl`.
fn passed(covered: &Covered) -> u32 {
    let tail = covered.item[3];
    if flow::jumps(tail, covered.coverage.0) > 0.0 {
        flow::target(tail, covered.next)
    } else {
        covered.next
    }
}

/// With translucent paints.
pub(super) fn translucent(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    if sampler.settings.filter == filter::POINT && !sampler.settings.outline {
        point(sampler, first, lookup)
    } else {
        ramp(sampler, first, lookup)
    }
}

/// Where edges are hard: front to back, sRGB-encoded.
fn point(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    // The colour of a single hit needs no transfer function.
    let mut only = [0.0; 4];
    let mut color = [0.0; 4];
    let mut hit_count = 0;
    let mut item = first;
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let covered = coverage(sampler, item, lookup);
        if covered.item[3] & CONTROL_BIT != 0 {
            item = passed(&covered);
            if sampler.is_past(item) {
                break;
            }
            continue;
        }
        let entry = Entry::<[f32; 4]>::of(sampler, &covered, lookup);
        let shown = entry.shown();
        item = entry.next;
        if shown[3] > 0.0 {
            only = shown;
            hit_count += 1;
            color = color.plus(over_encoded(sampler, &entry).scaled(1.0 - color[3]));
        }
        if color[3] >= 1.0 || entry.head & LAST_BIT != 0 || sampler.is_past(entry.next) {
            break;
        }
    }
    if hit_count > 1 {
        color::decode_premultiplied(color)
    } else {
        only
    }
}

/// The WGSL walks both ways in one loop to be compiled small; here the two directions are two
/// functions.
fn ramp(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let ramp = sampler.settings.filter != filter::POINT;
    let mut front = [0.0; 4];
    let mut through = 1.0;
    let mut color = [0.0; 4];
    let mut hit_count = 0;
    let mut item = first;
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let entry = Entry::<[f32; 4]>::new(sampler, item, lookup);
        let opaque = opaque(sampler, entry.head);
        if ramp && !opaque {
            return front.plus(behind(sampler, item, lookup).scaled(through));
        }
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
        if through <= 0.0 || entry.head & LAST_BIT != 0 || sampler.is_past(entry.next) {
            break;
        }
        item = entry.next;
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
    let mut item = last(sampler, first);
    for _ in 0..MAX_ENTRIES_PER_CELL {
        let entry = Entry::new(sampler, item, lookup);
        if entry.coverage() > 0.0 {
            color = over(sampler, &entry, color);
        }
        if item == first {
            break;
        }
        item = before(sampler, first, item);
    }
    color
}

/// First item of the last entry from the entry at `first` on.
fn last(sampler: &Sampler<'_>, first: u32) -> u32 {
    let mut last = first;
    let mut item = first;
    for _ in 0..LIMIT {
        let tail = sampler.word(item.wrapping_add(3));
        if tail & LAST_BIT != 0 || sampler.is_past(item) {
            break;
        }
        item = item.wrapping_add(WORDS);
        if tail & END_BIT != 0 {
            last = item;
        }
    }
    last
}

/// First item of the entry before the one at `item`; no list begins behind `first`.
fn before(sampler: &Sampler<'_>, first: u32, item: u32) -> u32 {
    let mut before = item.wrapping_sub(WORDS);
    for _ in 0..LIMIT {
        if before <= first || sampler.word(before - 1) & END_BIT != 0 {
            break;
        }
        before = before.wrapping_sub(WORDS);
    }
    before
}
