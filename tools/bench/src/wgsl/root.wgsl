// One lookup an invocation. The kernel's own file gives
// `fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f`.

struct BenchQuery {
    uv: vec2f,
    padding: vec2f,
    footprint: vec4f,
}

@group(1) @binding(0) var<storage, read> bench_queries: array<BenchQuery>;
@group(1) @binding(1) var<storage, read_write> bench_results: array<vec4f>;

@compute @workgroup_size(64)
fn bench_main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&bench_queries) {
        let query = bench_queries[id.x];
        bench_results[id.x] = bench_sample(query.uv, query.footprint);
    }
}
