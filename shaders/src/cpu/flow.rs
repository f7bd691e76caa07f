//! Twin of `vtex/flow_point.wgsl` and `vtex/flow_ramp.wgsl`: how a walk goes on at tests.

use super::frames::Frames;
use crate::layout::item;

/// Whether a control item with this last word is a test or a jump.
pub(super) const fn tests(tail: u32) -> bool {
    let op = tail & item::CONTROL_MASK;
    tail & item::KIND_MASK == item::CURVES || op == item::JUMP
}

/// Where a control item passes over items to, when `next` follows it.
pub(super) const fn target(tail: u32, next: u32) -> u32 {
    match tail & item::INDEX_MASK {
        0 => item::BEYOND,
        over => next.wrapping_add(over.wrapping_mul(item::WORDS)),
    }
}

/// What of a lookup that a test covers by `coverage` jumps.
pub(super) fn jumps(tail: u32, coverage: f32) -> f32 {
    if tail & item::OPAQUE_BIT != 0 {
        coverage
    } else {
        1.0 - coverage
    }
}

/// Takes in the jumps that end at the item `at`.
pub(super) fn arrive(frames: &mut Frames, at: u32) {
    if frames.ends != at {
        return;
    }
    let Some(jumps) = frames.pop() else {
        return;
    };
    let share = frames.share + jumps.share;
    let color = frames.color;
    frames.color = std::array::from_fn(|i| (frames.share * color[i] + jumps.color[i]) / share);
    frames.share = share;
}

/// The item to go on with, when a part `jumps` goes on at `ends` and the rest at `next`.
pub(super) fn test(frames: &mut Frames, jumps: f32, next: u32, ends: u32) -> u32 {
    if jumps <= 0.0 {
        return next;
    }
    let alone = frames.ends == 0 || ends <= frames.ends;
    if jumps >= 1.0 && alone {
        return ends;
    }
    frames.wait(frames.share * jumps, ends);
    frames.share *= 1.0 - jumps;
    if frames.share > 0.0 {
        next
    } else {
        frames.ends
    }
}
