//!use state/dispatch
// After a stage that has filled queues or the list of shadow rays.

@compute @workgroup_size(64)
fn stage_arguments(@builtin(local_invocation_index) lane: u32) {
    if lane < arrayLength(&stage_counts) - COUNT_LOOKUPS {
        dispatch_set(DISPATCH_LOOKUPS + lane, atomicLoad(&stage_counts[COUNT_LOOKUPS + lane]));
    }
    if lane == 0u {
        dispatch_set(DISPATCH_SHADOWS, list_shadows());
    }
}
