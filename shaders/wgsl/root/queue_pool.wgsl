//!use root/queue
//!use root/set
// The kernel of one pool's part of a queue.

@group(2) @binding(0) var<storage, read> vtex_queue_parts: array<VtexQueuePart>;
@group(2) @binding(1) var<storage, read> vtex_queue_order: array<u32>;

@compute @workgroup_size(64)
fn vtex_queue_pool(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = vtex_queue_invocation(group, group_count, lane);
    let part = vtex_queue_parts[vtex_words[0][VTEX_SET_POOL]];
    // No branch around the lookup: see vtex/texture.
    let index = vtex_queue_order[part.first + min(place, max(part.count, 1u) - 1u)];
    let query = vtex_queue_queries[index];
    let color = vtex_sample(query.handle, query.uv, query.footprint);
    if place < part.count {
        vtex_queue_colors[index] = color;
    }
}
