// One lookup an invocation, a workgroup four screen tiles: graphics cards begin no more than about one
// workgroup a clock, and with one tile each that was all that cheap lookups measured. The kernel's own
// file gives `fn bench_sample(uv: vec2f, footprint: vec4f) -> vec4f` with its resources in group 0.
// The queries are those of queries.rs; every run of the benchmark compares the two.

struct BenchQueries {
    origin: vec2f,
    pixel: vec2f,
    size_px: vec2u,
    scattered: u32,
    stride: u32,
    lookups: u32,
    // 1: write results. Timed runs do not, since writing takes as long as a cheap lookup.
    keeps: u32,
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

@compute @workgroup_size(256)
fn bench_main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let q = bench_queries;
    // Those that are too many repeat the last. A branch around all that follows would keep drivers from
    // loading for a whole group what all its lanes need.
    let index = min((group.y * groups.x + group.x) * 256u + lane, q.lookups - 1u);
    let seed = bench_scramble(index);
    let jitter = vec2f(bench_unit(seed), bench_unit(bench_scramble(seed ^ 0x9e3779b9u)));
    let tiles = q.size_px / 8u;
    let row = index / 64u / tiles.x;
    let tile = vec2u(index / 64u - row * tiles.x, row % tiles.y);
    let frame = row / tiles.y;
    let shift = (frame * vec2u(3u, 5u)) % q.stride;
    let block = tile / 8u * q.stride + shift;
    let pixel = (block * 8u + tile % 8u) * 8u + vec2u(index % 8u, index % 64u / 8u);
    let on_screen = q.origin + (vec2f(pixel) + jitter) * q.pixel;
    let uv = select(on_screen, jitter, q.scattered == 1u);
    let color = bench_sample(uv, vec4f(q.pixel.x, 0.0, 0.0, q.pixel.y));
    // No colour is so low, which compilers do not know.
    if q.keeps == 1u || dot(color, vec4f(1.0)) < -1e30 {
        bench_results[min(index, arrayLength(&bench_results) - 1u)] = color;
    }
}
