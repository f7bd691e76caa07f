//!use root/queue
//!use root/set
// The kernel of a queue whose textures lie in one pool.

@compute @workgroup_size(64)
fn vtex_queue(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = vtex_queue_invocation(group, group_count, lane);
    // No branch around the lookup: see vtex/texture.
    let length = vtex_queue_length();
    let query = vtex_queue_queries[min(index, max(length, 1u) - 1u)];
    let color = vtex_sample(query.handle, query.uv, query.footprint);
    if index < length {
        vtex_queue_colors[index] = color;
    }
}
