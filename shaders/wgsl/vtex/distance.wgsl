//!use core/layout
//!use vtex/segment
// How far a lookup is from a segment. Twin: cpu/segment.rs.

// Squared distance from `p`, by Newton's method on the squared distance along
// a + 2 b1 t + c2 t^2. Whatever it ends at is a point of the curve, so errors only make the
// result larger.
fn vtex_segment_distance_squared(item: vec4u, p: vec2f) -> f32 {
    let a = vtex_segment_point(item.x) - p;
    let c = vtex_segment_point(item.y) - p;
    let b = vtex_segment_point(item.z) - p;
    let chord = b - a;
    let b1 = select(c - a, 0.5 * chord, (item.w & VTEX_ITEM_LINE_BIT) != 0u);
    let c2 = chord - 2.0 * b1;
    // Different lattice points lie at least one unit apart.
    var t = clamp(-dot(a, chord) / max(dot(chord, chord), 1.0), 0.0, 1.0);
    for (var i = 0u; i < VTEX_CURVE_NEWTON_STEPS; i++) {
        let half_slope = b1 + c2 * t;
        let v = a + t * (b1 + half_slope);
        let first = dot(v, half_slope);
        let slope_squared = dot(half_slope, half_slope);
        // Half of B'' is c2; where the squared distance is not convex, step as Gauss and Newton.
        let second = 2.0 * slope_squared + dot(v, c2);
        let convex = select(2.0 * slope_squared, second, second > slope_squared);
        t = clamp(t - first / max(convex, 1e-6), 0.0, 1.0);
    }
    let v = a + t * (b1 + (b1 + c2 * t));
    return dot(v, v);
}
