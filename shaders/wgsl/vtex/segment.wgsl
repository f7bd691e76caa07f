//!use core/layout
// A segment of an outline at a lookup. docs/format.md, "Curve records". Twin: cpu/segment.rs.
// `p` is in units of the cell's box.

fn vtex_segment_point(word: u32) -> vec2f {
    return vec2f(f32(word & 0xffffu), f32(word >> 16u));
}

fn vtex_segment_cross(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// By how much the winding changes where the ray that runs left from `p` meets the segment. Half
// open, so that of two segments that meet on the ray's height one counts.
//
// In barycentric coordinates of the triangle (a, c, b) the curve is l1^2 = 4 l0 l2, and what
// lies between it and its chord has l1 > 0 and l1^2 < 4 l0 l2. There the chord and the curve
// pass on different sides. Nothing is divided, so nothing can blow up. A line has c = a, so that
// nothing lies between. No branches: each costs more than what it would skip.
fn vtex_segment_winding(command: vec4u, p: vec2f) -> i32 {
    let a = vtex_segment_point(command.x) - p;
    let c = vtex_segment_point(command.y) - p;
    let b = vtex_segment_point(command.z) - p;
    let chord = vtex_segment_cross(a, b);
    let bend = vtex_segment_cross(c - a, b - a);
    let inner = 4.0 * vtex_segment_cross(c, b) * vtex_segment_cross(a, c);
    let between = (chord * bend < 0.0) & (chord * chord < inner);
    let crosses = (a.y <= 0.0) & (b.y > 0.0) & ((chord <= 0.0) != between);
    let direction = select(-1, 1, (command.w & VTEX_CMD_DOWN_BIT) != 0u);
    return select(0, direction, crosses);
}
