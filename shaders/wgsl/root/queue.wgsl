//!use core/set
// A queue of lookups that other work on the GPU has filled, and how long it is.

@group(0) @binding(0) var<storage, read> vtex_queue_queries: array<VtexTextureQuery>;
@group(0) @binding(1) var<storage, read> vtex_queue_count: array<u32>;
@group(0) @binding(2) var<storage, read_write> vtex_queue_colors: array<vec4f>;

// A count past either array's end is that of the array: what filled the queue may go on counting.
fn vtex_queue_length() -> u32 {
    let room = min(arrayLength(&vtex_queue_queries), arrayLength(&vtex_queue_colors));
    return min(vtex_queue_count[0], room);
}

// Which invocation of the whole dispatch this is.
fn vtex_queue_invocation(group: vec3u, group_count: vec3u, lane: u32) -> u32 {
    return (group.x + group.y * group_count.x) * 64u + lane;
}
