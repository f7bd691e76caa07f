//! Winding from a curve record as a file stores it (docs/format.md 2.13). Tests compare
//! evaluators with it, which read commands made from records.
//!
//! `record` below starts at the first word of what [`vtex_format::CurveHeader`] describes and may
//! be longer; words that are missing count as segments that are not there. `p` is in units of the
//! record's box.

use vtex_format::{
    CURVE_HEADER_WORDS, CURVE_LINE_WORDS, CURVE_QUAD_WORDS, MAX_CURVE_SEGMENTS, MAX_CURVE_STEPS,
};

use crate::cpu::plane::{Vec2, cross, point, sub};

/// Where the parts of a record lie.
struct Parts<'a> {
    steps: &'a [u32],
    lines: &'a [[u32; CURVE_LINE_WORDS as usize]],
    down_lines: usize,
    quads: &'a [[u32; CURVE_QUAD_WORDS as usize]],
    down_quads: usize,
    even_odd: bool,
    base: i32,
}

fn parts(record: &[u32]) -> Parts<'_> {
    let first = record.first().copied().unwrap_or(0);
    let second = record.get(1).copied().unwrap_or(0);
    let count = |word: u32| (word & MAX_CURVE_SEGMENTS) as usize;
    let rest = record.get(CURVE_HEADER_WORDS as usize..).unwrap_or(&[]);
    let (steps, rest) = split(rest, ((first >> 22) & MAX_CURVE_STEPS) as usize);
    let (lines, rest) = split(rest, count(first) * CURVE_LINE_WORDS as usize);
    let (quads, _) = split(rest, count(first >> 11) * CURVE_QUAD_WORDS as usize);
    Parts {
        steps,
        lines: lines.as_chunks().0,
        down_lines: count(second),
        quads: quads.as_chunks().0,
        down_quads: count(second >> 11),
        even_odd: first >> 31 != 0,
        base: second.cast_signed() >> 22,
    }
}

fn split(words: &[u32], at: usize) -> (&[u32], &[u32]) {
    // A record that breaks off has fewer segments, not other ones.
    words.split_at(at.min(words.len()))
}

fn direction(index: usize, down: usize) -> i32 {
    if index < down { 1 } else { -1 }
}

/// Winding left of everything in the box, on the height of `p`.
fn left_winding(parts: &Parts<'_>, p: Vec2) -> i32 {
    let mut winding = parts.base;
    for &step in parts.steps {
        // Half open as the segments are: a step counts from its own height on.
        // The low half is y, the high half the signed change.
        if point(step)[0] <= p[1] {
            winding += step.cast_signed() >> 16;
        }
    }
    winding
}

/// Whether the line from `a` down to `b`, both relative to the lookup, meets the ray that runs
/// left from it. Half open, so that of two lines that meet on the ray's height one counts.
fn line_crosses_left(a: Vec2, b: Vec2) -> bool {
    a[1] <= 0.0 && b[1] > 0.0 && cross(a, b) <= 0.0
}

/// As [`line_crosses_left`], for the quadratic with control point `c`.
///
/// In barycentric coordinates of the triangle (a, c, b) the curve is `l1^2 = 4 l0 l2`, and what
/// lies between it and its chord has `l1 > 0` and `l1^2 < 4 l0 l2`. There the chord and the curve
/// pass on different sides. Nothing is divided, so nothing can blow up.
fn quad_crosses_left(a: Vec2, c: Vec2, b: Vec2) -> bool {
    if !(a[1] <= 0.0 && b[1] > 0.0) {
        return false;
    }
    let chord = cross(a, b);
    let bend = cross(sub(c, a), sub(b, a));
    let between = chord * bend < 0.0 && chord * chord < 4.0 * cross(c, b) * cross(a, c);
    (chord <= 0.0) != between
}

/// The winding number at `p`, whatever the fill rule.
pub fn winding(record: &[u32], p: Vec2) -> i32 {
    let parts = parts(record);
    let mut winding = left_winding(&parts, p);
    for (i, line) in parts.lines.iter().enumerate() {
        let a = sub(point(line[0]), p);
        let b = sub(point(line[1]), p);
        if line_crosses_left(a, b) {
            winding += direction(i, parts.down_lines);
        }
    }
    for (i, quad) in parts.quads.iter().enumerate() {
        let a = sub(point(quad[0]), p);
        let b = sub(point(quad[2]), p);
        if quad_crosses_left(a, sub(point(quad[1]), p), b) {
            winding += direction(i, parts.down_quads);
        }
    }
    winding
}

/// Whether `p` is filled.
pub fn inside(record: &[u32], p: Vec2) -> bool {
    fills(winding(record, p), parts(record).even_odd)
}

fn fills(winding: i32, even_odd: bool) -> bool {
    if even_odd {
        winding & 1 != 0
    } else {
        winding != 0
    }
}
