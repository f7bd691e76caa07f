//!use root/queue
//!use root/queue_dispatch
// Turns the length of a queue into the arguments of its dispatch.

@group(1) @binding(0) var<storage, read_write> vtex_queue_dispatch: array<u32, 3>;

@compute @workgroup_size(1)
fn vtex_queue_arguments() {
    let groups = vtex_queue_groups(vtex_queue_length());
    vtex_queue_dispatch = array<u32, 3>(groups.x, groups.y, groups.z);
}
