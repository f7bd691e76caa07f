//!use root/queue
// Turns the length of a queue into the arguments of its dispatch.

// Lookups of a workgroup.
const VTEX_QUEUE_WORKGROUP: u32 = 64u;
// Workgroups along an axis on every device.
const VTEX_QUEUE_GROUPS: u32 = 65535u;

@group(1) @binding(0) var<storage, read_write> vtex_queue_dispatch: array<u32, 3>;

@compute @workgroup_size(1)
fn vtex_queue_arguments() {
    let length = vtex_queue_length();
    let groups = (length + VTEX_QUEUE_WORKGROUP - 1u) / VTEX_QUEUE_WORKGROUP;
    // Rows as equal as they can be: fewer workgroups stand idle than there are rows.
    let rows = (groups + VTEX_QUEUE_GROUPS - 1u) / VTEX_QUEUE_GROUPS;
    let divisor = max(rows, 1u);
    let columns = (groups + divisor - 1u) / divisor;
    vtex_queue_dispatch = array<u32, 3>(columns, rows, min(rows, 1u));
}
