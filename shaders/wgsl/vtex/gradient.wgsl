//!use core/layout
//!use vtex/texture
// Gradients: a parameter t from the place, then a colour from t.

// Stops at or before t. Offsets stand in groups of four; the last group is filled with numbers
// that no t reaches.
fn vtex_gradient_passed(vt: VtexTexture, offsets: u32, count: u32, t: f32) -> u32 {
    var low = 0u;
    var high = (count + 3u) >> 2u;
    for (var i = 0u; i < VTEX_GRADIENT_SEARCH_STEPS; i += 1u) {
        if high - low <= 1u {
            break;
        }
        let middle = (low + high) >> 1u;
        let before = vtex_word_float(vt, offsets + 4u * middle) <= t;
        low = select(low, middle, before);
        high = select(middle, high, before);
    }
    let group = vtex_word_float4(vt, offsets + 4u * low);
    let passed = select(vec4u(0u), vec4u(1u), group <= vec4f(t));
    return min(4u * low + passed.x + passed.y + passed.z + passed.w, count);
}

// Straight alpha, sRGB-encoded. `stops`: first word of the offsets, colours follow their groups.
fn vtex_gradient_color(vt: VtexTexture, stops: u32, count: u32, t: f32) -> vec4f {
    let passed = vtex_gradient_passed(vt, stops, count, t);
    let left = max(passed, 1u) - 1u;
    let right = min(passed, count - 1u);
    let start = vtex_word_float(vt, stops + left);
    let end = vtex_word_float(vt, stops + right);
    let colors = stops + ((count + 3u) & 0xfffffffcu);
    let first = vtex_word_float4(vt, colors + 4u * left);
    let second = vtex_word_float4(vt, colors + 4u * right);
    // Before the first stop and behind the last both are the same one.
    let span = select(end - start, 1.0, left == right);
    return first + (t - start) / span * (second - first);
}

struct VtexGradientCircle {
    t: f32,
    exists: bool,
}

// The circle through `p` with the greatest t of those whose radius is not negative; centres at
// (t distance, 0), radii focal + t (1 - focal). `leading`: distance^2 - (1 - focal)^2.
fn vtex_gradient_circle(p: vec2f, distance: f32, focal: f32, leading: f32) -> VtexGradientCircle {
    let growth = 1.0 - focal;
    let half = p.x * distance + focal * growth;
    let rest = p.x * p.x + p.y * p.y - focal * focal;
    let discriminant = half * half - leading * rest;
    // The sum without cancellation, then both roots from it.
    let root = sqrt(max(discriminant, 0.0));
    let sum = half + select(-root, root, half >= 0.0);
    let linear = leading == 0.0;
    let other = select(rest / select(sum, 1.0, sum == 0.0), 0.0, sum == 0.0);
    let one = select(sum / select(leading, 1.0, linear), other, linear);
    let greater = max(one, other);
    let t = select(min(one, other), greater, focal + greater * growth >= 0.0);
    // Of circles one of which lies within the other every point has one, rounding or not.
    let nested = leading < 0.0;
    let exists = nested || (discriminant >= 0.0 && focal + t * growth >= 0.0);
    return VtexGradientCircle(t, exists);
}

fn vtex_gradient_spread(t: f32, about: u32) -> f32 {
    let spread = about & VTEX_GRADIENT_SPREAD_MASK;
    if spread == VTEX_GRADIENT_REPEAT {
        return t - floor(t);
    }
    if spread == VTEX_GRADIENT_REFLECT {
        return 1.0 - abs(t - 2.0 * floor(0.5 * t) - 1.0);
    }
    return t;
}

// Straight alpha, sRGB-encoded. `first`: first word of the gradient.
fn vtex_gradient(vt: VtexTexture, first: u32, uv: vec2f) -> vec4f {
    let head = vtex_word4(vt, first);
    let row = bitcast<vec4f>(head);
    let about = head.w;
    let x = row.x * uv.x + row.y * uv.y + row.z;
    let kind = about & VTEX_GRADIENT_KIND_MASK;
    var t = x;
    var stops = first + VTEX_GRADIENT_LINEAR_WORDS;
    if kind != VTEX_GRADIENT_LINEAR {
        stops = first + VTEX_GRADIENT_CIRCLE_WORDS;
        let line = vtex_word_float4(vt, first + 4u);
        let p = vec2f(x, line.x * uv.x + line.y * uv.y + line.z);
        if kind == VTEX_GRADIENT_ROUND {
            t = sqrt(p.x * p.x + p.y * p.y);
        } else {
            let circles = vtex_word_float4(vt, first + 8u);
            let circle = vtex_gradient_circle(p, circles.x, circles.y, line.w);
            if !circle.exists {
                return vec4f(0.0);
            }
            t = circle.t;
        }
    }
    let count = about & VTEX_GRADIENT_COUNT_MASK;
    return vtex_gradient_color(vt, stops, count, vtex_gradient_spread(t, about));
}
