// One MSDF sample from a texture: four loads, bilinear by hand, median.

@group(0) @binding(0) var field: texture_2d<f32>;

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    let last = vec2f(textureDimensions(field)) - 1.0;
    let x = clamp(uv * last, vec2f(0.0), last);
    let low = min(floor(x), last - 1.0);
    let t = x - low;
    let p = vec2u(low);
    let upper = mix(textureLoad(field, p, 0), textureLoad(field, p + vec2u(1u, 0u), 0), t.x);
    let lower = mix(textureLoad(field, p + vec2u(0u, 1u), 0), textureLoad(field, p + 1u, 0), t.x);
    let c = mix(upper, lower, t.y);
    return vec4f(max(min(c.r, c.g), min(max(c.r, c.g), c.b)));
}
