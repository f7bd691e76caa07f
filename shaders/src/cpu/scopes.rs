//! Twin of `vtex/scopes_point.wgsl` and `vtex/scopes_ramp.wgsl`: lists that hold groups, or clips
//! where edges are ramps, whose items lie back to front.

use super::coverage::coverage;
use super::entry::Entry;
use super::flow;
use super::frames::Frames;
use super::group::{Tone, group};
use super::over::{over, over_encoded};
use super::{Lookup, Sampler, Value, color};
use crate::layout::{filter, item};

pub(super) fn scopes(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let settings = &sampler.settings;
    if settings.filter == filter::POINT && !settings.outline {
        point(sampler, first, lookup)
    } else {
        ramp(sampler, first, lookup)
    }
}

/// Where edges are hard: sRGB-encoded.
fn point(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut frames = Frames::new();
    let mut at = first;
    for _ in 0..item::LIMIT {
        if sampler.is_past(at) {
            break;
        }
        let covered = coverage(sampler, at, lookup);
        let tail = covered.item[3];
        at = next(tail, covered.next);
        if tail & item::CONTROL_BIT != 0 {
            let jumps = if flow::tests(tail) {
                flow::jumps(tail, covered.coverage.0) > 0.0
            } else {
                group(&mut frames, covered.item, Tone::Encoded)
            };
            if jumps {
                at = flow::target(tail, covered.next);
            }
        } else if covered.coverage.0 > 0.0 {
            let entry = Entry::of(sampler, &covered, lookup);
            let shown = over_encoded(sampler, &entry);
            frames.color = shown.plus(frames.color.scaled(1.0 - shown[3]));
        }
    }
    color::decode_premultiplied(frames.color)
}

/// Where edges are ramps: in linear light.
fn ramp(sampler: &Sampler<'_>, first: u32, lookup: &Lookup) -> [f32; 4] {
    let mut frames = Frames::new();
    let mut at = first;
    for _ in 0..item::LIMIT {
        if sampler.is_past(at) {
            break;
        }
        flow::arrive(&mut frames, at);
        let covered = coverage(sampler, at, lookup);
        let tail = covered.item[3];
        at = next(tail, covered.next);
        if tail & item::CONTROL_BIT != 0 {
            let ends = flow::target(tail, covered.next);
            if flow::tests(tail) {
                let jumps = flow::jumps(tail, covered.coverage.0);
                at = flow::test(&mut frames, jumps, at, ends);
            } else if group(&mut frames, covered.item, Tone::Linear) {
                at = ends;
            }
        } else {
            let entry = Entry::of(sampler, &covered, lookup);
            if entry.coverage() > 0.0 {
                frames.color = over(sampler, &entry, frames.color);
            }
        }
    }
    flow::arrive(&mut frames, item::BEYOND);
    frames.color
}

/// What follows an entry in the walk.
const fn next(tail: u32, next: u32) -> u32 {
    if tail & item::LAST_BIT != 0 {
        item::BEYOND
    } else {
        next
    }
}
