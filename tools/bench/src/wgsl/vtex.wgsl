
// Behind the evaluator's own text.
fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f {
    return vtex_sample(uv, footprint);
}
