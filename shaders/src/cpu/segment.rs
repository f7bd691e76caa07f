//! Twin of `vtex/segment.wgsl`: a segment of an outline at a lookup. `p` is in units of the cell's
//! box.

use super::plane::{Vec2, cross, point, sub};
use crate::layout::cmd::DOWN_BIT;

/// By how much the winding changes where the ray that runs left from `p` meets the segment.
pub(super) fn winding(command: [u32; 4], p: Vec2) -> i32 {
    let a = sub(point(command[0]), p);
    let b = sub(point(command[2]), p);
    // The GPU's text has no branch; this one skips the rest for most segments.
    if !(a[1] <= 0.0 && b[1] > 0.0) {
        return 0;
    }
    let c = sub(point(command[1]), p);
    let chord = cross(a, b);
    let bend = cross(sub(c, a), sub(b, a));
    let inner = 4.0 * cross(c, b) * cross(a, c);
    let between = chord * bend < 0.0 && chord * chord < inner;
    if (chord <= 0.0) == between {
        return 0;
    }
    if command[3] & DOWN_BIT != 0 { 1 } else { -1 }
}

/// Whether the winding is the same all over the box from `low` to `high`, as far as this segment
/// alone tells.
pub(super) fn is_constant(command: [u32; 4], low: Vec2, high: Vec2) -> bool {
    let [a, b] = [point(command[0]), point(command[2])];
    if high[1] < a[1] || low[1] >= b[1] || high[0] < a[0].min(b[0]) {
        return true;
    }
    if low[1] < a[1] || high[1] >= b[1] {
        return false;
    }
    // Monotone: it passes the box where these two corners lie on one side of it.
    let corners = if a[0] < b[0] {
        [[low[0], high[1]], [high[0], low[1]]]
    } else {
        [low, high]
    };
    let [one, other] = corners.map(|corner| winding(command, corner));
    one == other
}
