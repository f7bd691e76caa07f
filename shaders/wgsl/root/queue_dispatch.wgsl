// The arguments of a dispatch over so many lookups.

// Lookups of a workgroup.
const VTEX_QUEUE_WORKGROUP: u32 = 64u;
// Workgroups along an axis on every device.
const VTEX_QUEUE_GROUPS: u32 = 65535u;

fn vtex_queue_groups(length: u32) -> vec3u {
    let groups = (length + VTEX_QUEUE_WORKGROUP - 1u) / VTEX_QUEUE_WORKGROUP;
    // Rows as equal as they can be: fewer workgroups stand idle than there are rows.
    let rows = (groups + VTEX_QUEUE_GROUPS - 1u) / VTEX_QUEUE_GROUPS;
    let divisor = max(rows, 1u);
    let columns = (groups + divisor - 1u) / divisor;
    return vec3u(columns, rows, min(rows, 1u));
}
