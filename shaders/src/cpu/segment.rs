//! Twin of `vtex/segment.wgsl`: a segment of an outline at a lookup. `p` is in units of the cell's
//! box.

use super::math::clamp;
use super::plane::{Vec2, cross, dot, point, sub};
use crate::layout::curve::NEWTON_STEPS;
use crate::layout::item::{DOWN_BIT, LINE_BIT};

/// By how much the winding changes where the ray that runs left from `p` meets the segment.
pub(super) fn winding(item: [u32; 4], p: Vec2) -> i32 {
    let a = sub(point(item[0]), p);
    let b = sub(point(item[2]), p);
    // The GPU's text has no branch; this one skips the rest for most segments.
    if !(a[1] <= 0.0 && b[1] > 0.0) {
        return 0;
    }
    let c = sub(point(item[1]), p);
    let chord = cross(a, b);
    let bend = cross(sub(c, a), sub(b, a));
    let inner = 4.0 * cross(c, b) * cross(a, c);
    let between = chord * bend < 0.0 && chord * chord < inner;
    if (chord <= 0.0) == between {
        return 0;
    }
    if item[3] & DOWN_BIT != 0 { 1 } else { -1 }
}

/// Squared distance from `p`; whether `limit` is exceeded is all that is right beyond it.
pub(super) fn distance_squared(item: [u32; 4], p: Vec2, limit: f32) -> f32 {
    let a = sub(point(item[0]), p);
    let b = sub(point(item[2]), p);
    // Monotone, so its ends span its box.
    let beyond = box_distance_squared(a, b);
    if beyond >= limit {
        return beyond;
    }
    let c = sub(point(item[1]), p);
    let chord = sub(b, a);
    let b1 = if item[3] & LINE_BIT != 0 {
        [0.5 * chord[0], 0.5 * chord[1]]
    } else {
        sub(c, a)
    };
    let c2 = [chord[0] - 2.0 * b1[0], chord[1] - 2.0 * b1[1]];
    let mut t = clamp(-dot(a, chord) / dot(chord, chord).max(1.0), 0.0, 1.0);
    for _ in 0..NEWTON_STEPS {
        let (v, half_slope) = at(a, b1, c2, t);
        let first = dot(v, half_slope);
        let slope_squared = dot(half_slope, half_slope);
        // Half of B'' is c2; where the squared distance is not convex, step as Gauss and Newton.
        let second = 2.0 * slope_squared + dot(v, c2);
        let convex = if second > slope_squared {
            second
        } else {
            2.0 * slope_squared
        };
        t = clamp(t - first / convex.max(1e-6), 0.0, 1.0);
    }
    let (v, _) = at(a, b1, c2, t);
    dot(v, v)
}

/// Whether the winding is the same all over the box from `low` to `high`, as far as this segment
/// alone tells.
pub(super) fn is_constant(item: [u32; 4], low: Vec2, high: Vec2) -> bool {
    let [a, b] = [point(item[0]), point(item[2])];
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
    let [one, other] = corners.map(|corner| winding(item, corner));
    one == other
}

fn box_distance_squared(a: Vec2, b: Vec2) -> f32 {
    let axis = |i: usize| a[i].min(b[i]).max(-a[i].max(b[i])).max(0.0);
    dot([axis(0), axis(1)], [axis(0), axis(1)])
}

/// Point and half the derivative.
fn at(a: Vec2, b1: Vec2, c2: Vec2, t: f32) -> (Vec2, Vec2) {
    let half_slope = [b1[0] + c2[0] * t, b1[1] + c2[1] * t];
    let v = [
        a[0] + t * (b1[0] + half_slope[0]),
        a[1] + t * (b1[1] + half_slope[1]),
    ];
    (v, half_slope)
}
