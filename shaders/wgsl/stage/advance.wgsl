//!use state/dispatch
// Ends a round: the list that was filled is the one to read, and everything else is empty.

@compute @workgroup_size(64)
fn stage_advance(@builtin(local_invocation_index) lane: u32) {
    if lane < arrayLength(&stage_counts) - COUNT_LOOKUPS {
        atomicStore(&stage_counts[COUNT_LOOKUPS + lane], 0u);
    }
    if lane == 0u {
        let read = atomicLoad(&stage_counts[COUNT_PARITY]);
        dispatch_set(DISPATCH_PATHS, min(atomicLoad(&stage_counts[1u - read]), state_room()));
        atomicStore(&stage_counts[read], 0u);
        atomicStore(&stage_counts[COUNT_SHADOWS], 0u);
        atomicStore(&stage_counts[COUNT_PARITY], 1u - read);
    }
}
