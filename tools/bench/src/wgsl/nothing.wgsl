// Makes the query and writes a result: what every other kernel pays as well.

@group(0) @binding(0) var<uniform> one: vec4f;

fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    return one * vec4f(uv, footprint.xw);
}
