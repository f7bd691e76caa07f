// One lookup an invocation, a workgroup a screen tile. The kernel's own file gives
// `fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f` with its resources in group 0.
// The queries are those of queries.rs; every run of the benchmark compares the two.

struct BenchQueries {
    origin: vec2f,
    pixel: vec2f,
    size_px: vec2u,
    scattered: u32,
    stride: u32,
}

@group(1) @binding(0) var<uniform> bench_queries: BenchQueries;
@group(1) @binding(1) var<storage, read_write> bench_results: array<vec4f>;

fn bench_scramble(value: u32) -> u32 {
    var bits = value;
    bits ^= bits >> 16u;
    bits *= 0x7feb352du;
    bits ^= bits >> 15u;
    bits *= 0x846ca68bu;
    return bits ^ (bits >> 16u);
}

fn bench_unit(bits: u32) -> f32 {
    return f32(bits >> 8u) / 16777216.0;
}

@compute @workgroup_size(8, 8)
fn bench_main(
    @builtin(workgroup_id) tile: vec3u,
    @builtin(num_workgroups) tiles: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = ((tile.z * tiles.y + tile.y) * tiles.x + tile.x) * 64u + lane;
    let seed = bench_scramble(index);
    let jitter = vec2f(bench_unit(seed), bench_unit(bench_scramble(seed ^ 0x9e3779b9u)));
    let q = bench_queries;
    let shift = (tile.z * vec2u(3u, 5u)) % q.stride;
    let block = tile.xy / 8u * q.stride + shift;
    let pixel = (block * 8u + tile.xy % 8u) * 8u + vec2u(lane % 8u, lane / 8u);
    let on_screen = q.origin + (vec2f(pixel) + jitter) * q.pixel;
    let uv = select(on_screen, jitter, q.scattered == 1u);
    bench_results[index] = bench_sample(uv, vec4f(q.pixel.x, 0.0, 0.0, q.pixel.y));
}
