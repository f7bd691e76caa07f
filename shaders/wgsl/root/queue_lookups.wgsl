//!use root/queue
//!use root/set
// The kernel of a queue: lookups in any texture of a set.

@compute @workgroup_size(64)
fn vtex_queue(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.x + group.y * group_count.x) * 64u + lane;
    // No branch around the lookup: see vtex/texture.
    let length = vtex_queue_length();
    let query = vtex_queue_queries[min(index, max(length, 1u) - 1u)];
    let color = vtex_sample(query.handle, query.uv, query.footprint);
    if index < length {
        vtex_queue_colors[index] = color;
    }
}
