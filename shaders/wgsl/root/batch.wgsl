//!use core/query
//!use root/answer
// The batch kernel: an array of queries in, an array of colours out.

@group(0) @binding(3) var<storage, read> vtex_queries: array<VtexBatchQuery>;
@group(0) @binding(4) var<storage, read_write> vtex_results: array<vec4f>;

@compute @workgroup_size(64)
fn vtex_batch(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.x + group.y * group_count.x) * 64u + lane;
    // No branch around the lookup: see vtex/texture.
    let count = min(arrayLength(&vtex_queries), arrayLength(&vtex_results));
    let query = vtex_queries[min(index, max(count, 1u) - 1u)];
    let result = vtex_answer(query);
    if index < count {
        vtex_results[index] = result;
    }
}
