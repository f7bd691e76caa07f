//! Twin of `vtex/gradient.wgsl`: a parameter t from the place, then a colour from t.

use super::Sampler;
use crate::layout::gradient::{
    CIRCLE_WORDS, COUNT_MASK, KIND_MASK, LINEAR, LINEAR_WORDS, REFLECT, REPEAT, ROUND,
    SEARCH_STEPS, SPREAD_MASK,
};

/// Stops at or before t.
fn passed(sampler: &Sampler<'_>, offsets: u32, count: u32, t: f32) -> u32 {
    let mut low = 0;
    let mut high = count.div_ceil(4);
    for _ in 0..SEARCH_STEPS {
        if high.wrapping_sub(low) <= 1 {
            break;
        }
        let middle = u32::midpoint(low, high);
        if sampler.word_float(offsets.wrapping_add(4 * middle)) <= t {
            low = middle;
        } else {
            high = middle;
        }
    }
    let group = sampler.word_float4(offsets.wrapping_add(4 * low));
    let within: u32 = group.iter().map(|&offset| u32::from(offset <= t)).sum();
    (4 * low + within).min(count)
}

/// Straight alpha, sRGB-encoded. `stops`: first word of the offsets.
fn color(sampler: &Sampler<'_>, stops: u32, count: u32, t: f32) -> [f32; 4] {
    let passed = passed(sampler, stops, count, t);
    let left = passed.max(1) - 1;
    let right = passed.min(count.wrapping_sub(1));
    let start = sampler.word_float(stops.wrapping_add(left));
    let end = sampler.word_float(stops.wrapping_add(right));
    let colors = stops.wrapping_add(count.next_multiple_of(4));
    let first = sampler.word_float4(colors.wrapping_add(left.wrapping_mul(4)));
    let second = sampler.word_float4(colors.wrapping_add(right.wrapping_mul(4)));
    let span = if left == right { 1.0 } else { end - start };
    let f = (t - start) / span;
    std::array::from_fn(|i| first[i] + f * (second[i] - first[i]))
}

/// t of the circle through `p`; `None` where there is none.
fn circle(p: [f32; 2], distance: f32, focal: f32, leading: f32) -> Option<f32> {
    let growth = 1.0 - focal;
    let half = p[0] * distance + focal * growth;
    let rest = p[0] * p[0] + p[1] * p[1] - focal * focal;
    let discriminant = half * half - leading * rest;
    let root = discriminant.max(0.0).sqrt();
    let sum = half + if half >= 0.0 { root } else { -root };
    let other = if is_zero(sum) { 0.0 } else { rest / sum };
    let one = if is_zero(leading) {
        other
    } else {
        sum / leading
    };
    let greater = one.max(other);
    let t = if focal + greater * growth >= 0.0 {
        greater
    } else {
        one.min(other)
    };
    let exists = leading < 0.0 || (discriminant >= 0.0 && focal + t * growth >= 0.0);
    exists.then_some(t)
}

fn is_zero(x: f32) -> bool {
    x.abs() <= 0.0
}

fn spread(t: f32, about: u32) -> f32 {
    match about & SPREAD_MASK {
        REPEAT => t - t.floor(),
        REFLECT => 1.0 - (t - 2.0 * (0.5 * t).floor() - 1.0).abs(),
        _ => t,
    }
}

/// Straight alpha, sRGB-encoded. `first`: first word of the gradient.
pub(super) fn gradient(sampler: &Sampler<'_>, first: u32, uv: [f32; 2]) -> [f32; 4] {
    let head: [u32; 4] = sampler.words(first);
    let about = head[3];
    let along = |row: [f32; 4]| row[0] * uv[0] + row[1] * uv[1] + row[2];
    let x = along(head.map(f32::from_bits));
    let kind = about & KIND_MASK;
    let mut t = x;
    let mut stops = first.wrapping_add(LINEAR_WORDS);
    if kind != LINEAR {
        stops = first.wrapping_add(CIRCLE_WORDS);
        let line = sampler.word_float4(first.wrapping_add(4));
        let p = [x, along(line)];
        if kind == ROUND {
            t = (p[0] * p[0] + p[1] * p[1]).sqrt();
        } else {
            let circles = sampler.word_float4(first.wrapping_add(8));
            match circle(p, circles[0], circles[1], line[3]) {
                Some(found) => t = found,
                None => return [0.0; 4],
            }
        }
    }
    color(sampler, stops, about & COUNT_MASK, spread(t, about))
}
