// Outlines without a grid, in the manner of Slug: every shape whose bounds hold the point, front to
// back; in a shape the curves of the point's horizontal and vertical band. Coverage is the winding
// along a ray to the right and one downwards, each crossing weighted by where it lies in the pixel.

struct BandShape {
    color: vec4f,
    bands: vec2u,
    first_word: u32,
    even_odd: u32,
}

@group(0) @binding(0) var<storage, read> band_bounds: array<vec4f>;
@group(0) @binding(1) var<storage, read> band_shapes: array<BandShape>;
@group(0) @binding(2) var<storage, read> band_words: array<u32>;
@group(0) @binding(3) var<storage, read> band_curves: array<vec4f>;

// Coverage along the ray in x, or in y where `turned`; then how far to trust it: fully where a
// crossing is at the pixel's centre, not at all half a pixel away.
fn band_ray(first: u32, count: u32, uv: vec2f, scale: vec2f, turned: bool) -> vec2f {
    var coverage = 0.0;
    var weight = 0.0;
    for (var i = first; i < first + count; i++) {
        let curve = band_words[i];
        let start = band_curves[curve];
        let end = band_curves[curve + 1u].xy;
        // In pixels, from the centre of this one.
        var p1 = (start.xy - uv) * scale;
        var p2 = (start.zw - uv) * scale;
        var p3 = (end - uv) * scale;
        if turned {
            p1 = p1.yx;
            p2 = p2.yx;
            p3 = p3.yx;
        }
        // Sorted by how far they reach: no later curve meets the ray.
        if max(max(p1.x, p2.x), p3.x) < -0.5 {
            break;
        }
        // Which roots count, by the signs of the three points alone (Lengyel's table).
        let signs = select(0u, 2u, p1.y > 0.0) + select(0u, 4u, p2.y > 0.0) + select(0u, 8u, p3.y > 0.0);
        let roots = (0x2e74u >> signs) & 3u;
        if roots == 0u {
            continue;
        }
        let a = p1 - 2.0 * p2 + p3;
        let b = p1 - p2;
        let d = sqrt(max(b.y * b.y - a.y * p1.y, 0.0));
        // Neither subtracts what is nearly equal, so that flat curves and lines have no case of
        // their own.
        let s = b.y + select(-d, d, b.y >= 0.0);
        let near = p1.y / s;
        let far = s / a.y;
        let t = clamp(select(vec2f(far, near), vec2f(near, far), b.y >= 0.0), vec2f(0.0), vec2f(1.0));
        let x = (a.x * t - 2.0 * b.x) * t + p1.x;
        let inside = saturate(x + 0.5);
        let trust = saturate(1.0 - 2.0 * abs(x));
        if (roots & 1u) != 0u {
            coverage += inside.x;
            weight = max(weight, trust.x);
        }
        if roots > 1u {
            coverage -= inside.y;
            weight = max(weight, trust.y);
        }
    }
    return vec2f(select(coverage, -coverage, turned), weight);
}

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let pixel = max(abs(footprint.xy) + abs(footprint.zw), vec2f(1e-9));
    let scale = 1.0 / pixel;
    var color = vec4f(0.0);
    let count = arrayLength(&band_bounds);
    for (var i = 0u; i < count; i++) {
        let bounds = band_bounds[i];
        if any(uv + 0.5 * pixel < bounds.xy) || any(uv - 0.5 * pixel > bounds.zw) {
            continue;
        }
        let shape = band_shapes[i];
        let last = vec2f(shape.bands - 1u);
        let at = (uv - bounds.xy) / (bounds.zw - bounds.xy) * vec2f(shape.bands.yx);
        let band = vec2u(clamp(at, vec2f(0.0), last.yx));
        let row = shape.first_word + 2u * band.y;
        let column = shape.first_word + 2u * (shape.bands.x + band.x);
        let h = band_ray(band_words[row], band_words[row + 1u], uv, scale, false);
        let v = band_ray(band_words[column], band_words[column + 1u], uv, scale, true);
        let mixed = abs(h.x * h.y + v.x * v.y) / max(h.y + v.y, 1.0 / 65536.0);
        let winding = max(mixed, min(abs(h.x), abs(v.x)));
        let odd = 1.0 - abs(1.0 - 2.0 * fract(0.5 * winding));
        let coverage = select(saturate(winding), odd, shape.even_odd == 1u);
        color += (1.0 - color.a) * coverage * shape.color;
        if color.a > 0.999 {
            break;
        }
    }
    return color;
}
