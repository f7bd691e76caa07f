// [SFG22]: one dense MSDF a shape, all of them in painter's order at every lookup. Four loads and
// a bilinear blend by hand, because samplers interpolate with too few bits for a distance.

struct Params {
    layer_count: u32,
    smoothing: f32,
}

@group(0) @binding(0) var layers: texture_2d_array<f32>;
@group(0) @binding(1) var<storage, read> paints: array<vec4f>;
@group(0) @binding(2) var<uniform> params: Params;

fn sfg22_median(c: vec3f) -> f32 {
    return max(min(c.r, c.g), min(max(c.r, c.g), c.b));
}

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let last = vec2f(textureDimensions(layers)) - 1.0;
    let x = clamp(uv * last, vec2f(0.0), last);
    let low = min(floor(x), last - 1.0);
    let t = x - low;
    let p = vec2u(low);
    var color = vec4f(0.0);
    // A bound that the compiler does not know: nothing is unrolled.
    for (var k = 0u; k < params.layer_count; k++) {
        let upper = mix(textureLoad(layers, p, k, 0), textureLoad(layers, p + vec2u(1u, 0u), k, 0), t.x);
        let lower = mix(textureLoad(layers, p + vec2u(0u, 1u), k, 0), textureLoad(layers, p + 1u, k, 0), t.x);
        let m = sfg22_median(mix(upper, lower, t.y).rgb);
        let paint = paints[k];
        // [SFG22] eq. 1, then source-over back to front.
        let alpha = paint.a * smoothstep(0.5 - params.smoothing, 0.5 + params.smoothing, m);
        color = color * (1.0 - alpha) + vec4f(paint.rgb, 1.0) * alpha;
    }
    return color;
}
