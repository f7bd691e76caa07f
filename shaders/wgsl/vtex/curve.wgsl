//!use core/layout
//!use vtex/words
//!use vtex/settings
// Winding and distance from the exact outline inside a cell. docs/format.md, "Curve records".
// Twin: cpu/curve.rs. `p` is in units of the record's box, `record` a word of texture `vt`.

struct VtexCurveParts {
    step_count: u32,
    line_count: u32,
    down_line_count: u32,
    quad_count: u32,
    down_quad_count: u32,
    first_step: u32,
    first_line: u32,
    first_quad: u32,
    base: i32,
    even_odd: bool,
}

// Counts are masked, so no loop below runs more than 2047 times.
fn vtex_curve_parts(vt: u32, record: u32) -> VtexCurveParts {
    let head = vtex_word2(vt, record);
    var parts: VtexCurveParts;
    parts.step_count = (head.x >> 22u) & VTEX_CURVE_STEP_MASK;
    parts.line_count = head.x & VTEX_CURVE_COUNT_MASK;
    parts.down_line_count = head.y & VTEX_CURVE_COUNT_MASK;
    parts.quad_count = (head.x >> 11u) & VTEX_CURVE_COUNT_MASK;
    parts.down_quad_count = (head.y >> 11u) & VTEX_CURVE_COUNT_MASK;
    parts.first_step = record + 2u;
    parts.first_line = parts.first_step + parts.step_count;
    parts.first_quad = parts.first_line + 2u * parts.line_count;
    parts.base = bitcast<i32>(head.y) >> 22u;
    parts.even_odd = (head.x >> 31u) != 0u;
    return parts;
}

fn vtex_curve_point(vt: u32, index: u32) -> vec2f {
    let word = vtex_word(vt, index);
    return vec2f(f32(word & 0xffffu), f32(word >> 16u));
}

fn vtex_curve_cross(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn vtex_curve_direction(index: u32, down: u32) -> i32 {
    return select(-1, 1, index < down);
}

// Winding left of everything in the box, on the height of `p`.
fn vtex_curve_left_winding(vt: u32, parts: VtexCurveParts, p: vec2f) -> i32 {
    var winding = parts.base;
    for (var i = 0u; i < parts.step_count; i++) {
        // The low half is y, the high half the signed change.
        let step = vtex_word(vt, parts.first_step + i);
        winding += select(0, bitcast<i32>(step) >> 16u, f32(step & 0xffffu) <= p.y);
    }
    return winding;
}

// Whether the line from `a` down to `b`, both relative to the lookup, meets the ray that runs
// left from it. Half open, so that of two lines that meet on the ray's height one counts.
fn vtex_curve_line_crosses_left(a: vec2f, b: vec2f) -> bool {
    return a.y <= 0.0 && b.y > 0.0 && vtex_curve_cross(a, b) <= 0.0;
}

// As for a line. In barycentric coordinates of the triangle (a, c, b) the curve is
// l1^2 = 4 l0 l2, and what lies between it and its chord has l1 > 0 and l1^2 < 4 l0 l2. There the
// chord and the curve pass on different sides. Nothing is divided, so nothing can blow up.
fn vtex_curve_quad_crosses_left(a: vec2f, c: vec2f, b: vec2f) -> bool {
    if !(a.y <= 0.0 && b.y > 0.0) {
        return false;
    }
    let chord = vtex_curve_cross(a, b);
    let bend = vtex_curve_cross(c - a, b - a);
    let between = chord * bend < 0.0
        && chord * chord < 4.0 * vtex_curve_cross(c, b) * vtex_curve_cross(a, c);
    return (chord <= 0.0) != between;
}

fn vtex_curve_fills(winding: i32, even_odd: bool) -> bool {
    return select(winding != 0, (winding & 1) != 0, even_odd);
}

// Whether `p` is filled.
fn vtex_curve_inside(vt: u32, record: u32, p: vec2f) -> bool {
    let parts = vtex_curve_parts(vt, record);
    var winding = vtex_curve_left_winding(vt, parts, p);
    for (var i = 0u; i < parts.line_count; i++) {
        let line = parts.first_line + 2u * i;
        let a = vtex_curve_point(vt, line) - p;
        let b = vtex_curve_point(vt, line + 1u) - p;
        if vtex_curve_line_crosses_left(a, b) {
            winding += vtex_curve_direction(i, parts.down_line_count);
        }
    }
    for (var i = 0u; i < parts.quad_count; i++) {
        let quad = parts.first_quad + 3u * i;
        let a = vtex_curve_point(vt, quad) - p;
        let c = vtex_curve_point(vt, quad + 1u) - p;
        let b = vtex_curve_point(vt, quad + 2u) - p;
        if vtex_curve_quad_crosses_left(a, c, b) {
            winding += vtex_curve_direction(i, parts.down_quad_count);
        }
    }
    return vtex_curve_fills(winding, parts.even_odd);
}

// Signed distance to the outline in units, inside positive, at most `reach` either way.
fn vtex_curve_distance(vt: u32, record: u32, p: vec2f, reach: f32) -> f32 {
    let parts = vtex_curve_parts(vt, record);
    var winding = vtex_curve_left_winding(vt, parts, p);
    var nearest = reach * reach;
    for (var i = 0u; i < parts.line_count; i++) {
        let line = parts.first_line + 2u * i;
        let a = vtex_curve_point(vt, line) - p;
        let b = vtex_curve_point(vt, line + 1u) - p;
        nearest = min(nearest, vtex_curve_line_distance_squared(a, b));
        if vtex_curve_line_crosses_left(a, b) {
            winding += vtex_curve_direction(i, parts.down_line_count);
        }
    }
    for (var i = 0u; i < parts.quad_count; i++) {
        let quad = parts.first_quad + 3u * i;
        let a = vtex_curve_point(vt, quad) - p;
        let c = vtex_curve_point(vt, quad + 1u) - p;
        let b = vtex_curve_point(vt, quad + 2u) - p;
        // Monotone, so its ends span its box.
        if vtex_curve_box_distance_squared(a, b) < nearest {
            nearest = min(nearest, vtex_curve_quad_distance_squared(a, c, b));
        }
        if vtex_curve_quad_crosses_left(a, c, b) {
            winding += vtex_curve_direction(i, parts.down_quad_count);
        }
    }
    let length = sqrt(nearest);
    return select(-length, length, vtex_curve_fills(winding, parts.even_odd));
}

fn vtex_curve_box_distance_squared(a: vec2f, b: vec2f) -> f32 {
    let v = max(max(min(a, b), -max(a, b)), vec2f(0.0));
    return dot(v, v);
}

// Squared distance from the origin.
fn vtex_curve_line_distance_squared(a: vec2f, b: vec2f) -> f32 {
    let e = b - a;
    // Different lattice points lie at least one unit apart.
    let t = clamp(-dot(a, e) / max(dot(e, e), 1.0), 0.0, 1.0);
    let v = a + e * t;
    return dot(v, v);
}

// Squared distance from the origin to a + 2 b1 t + c2 t^2, by Newton's method on the squared
// distance. Whatever it ends at is a point of the curve, so errors only make the result larger.
fn vtex_curve_quad_distance_squared(a: vec2f, c: vec2f, b: vec2f) -> f32 {
    let b1 = c - a;
    let c2 = (b - c) - b1;
    let chord = b - a;
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

// In texels, inside positive, far beyond every ramp where the record does not reach. `q` is the
// position inside the cell, `at` the record's place in its section. Only the sign is right when
// `sharp`.
fn vtex_curve_texels(vt: u32, at: u32, q: vec2f, sharp: bool) -> f32 {
    let record = vtex_word(vt, VTEX_HEADER_CURVES) + at;
    let lattice = vtex_word_float2(vt, VTEX_HEADER_CURVE_UNITS);
    let reach = lattice.y;
    let p = q * lattice.x + reach;
    if sharp || reach <= 0.0 {
        return select(-1e9, 1e9, vtex_curve_inside(vt, record, p));
    }
    let units = vtex_curve_distance(vt, record, p, reach);
    // The slack is for square roots that are not correctly rounded.
    if abs(units) >= reach * 0.999999 {
        return select(-1e9, 1e9, units > 0.0);
    }
    return units / lattice.x * f32(vtex_settings_texels_per_cell(vt));
}
