//!use root/queue
//!use root/queue_dispatch
// Puts a queue in the order of its pools: each then answers a part. Within a part the order is any.

const VTEX_QUEUE_POOLS: u32 = VTEX_SET_POOL_MASK + 1u;

// Queries of each pool, and behind them how many have their place.
@group(1) @binding(0) var<storage, read_write> vtex_queue_tallies: array<atomic<u32>>;
@group(1) @binding(1) var<storage, read_write> vtex_queue_parts: array<VtexQueuePart>;
@group(1) @binding(2) var<storage, read_write> vtex_queue_order: array<u32>;

// Of a workgroup: queries of each pool, and the place of the first.
var<workgroup> vtex_queue_own: array<atomic<u32>, VTEX_QUEUE_POOLS>;
var<workgroup> vtex_queue_places: array<u32, VTEX_QUEUE_POOLS>;

fn vtex_queue_pool_of(index: u32) -> u32 {
    return (vtex_queue_queries[index].handle >> VTEX_SET_POOL_SHIFT) & VTEX_SET_POOL_MASK;
}

@compute @workgroup_size(64)
fn vtex_queue_tally(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = vtex_queue_invocation(group, group_count, lane);
    if index < vtex_queue_length() {
        atomicAdd(&vtex_queue_own[vtex_queue_pool_of(index)], 1u);
    }
    workgroupBarrier();
    if lane < VTEX_QUEUE_POOLS {
        let own = atomicLoad(&vtex_queue_own[lane]);
        if own != 0u {
            atomicAdd(&vtex_queue_tallies[lane], own);
        }
    }
}

// A workgroup for each pool of the set.
@compute @workgroup_size(1)
fn vtex_queue_divide(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
) {
    var first = 0u;
    for (var pool = 0u; pool < group.x; pool++) {
        first += atomicLoad(&vtex_queue_tallies[pool]);
    }
    let count = atomicLoad(&vtex_queue_tallies[group.x]);
    let groups = vtex_queue_groups(count);
    vtex_queue_parts[group.x] = VtexQueuePart(groups, count, first, group_count.x, vec2u());
}

@compute @workgroup_size(64)
fn vtex_queue_sort(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) group_count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = vtex_queue_invocation(group, group_count, lane);
    let is_there = index < vtex_queue_length();
    var pool = 0u;
    var place = 0u;
    if is_there {
        pool = vtex_queue_pool_of(index);
        place = atomicAdd(&vtex_queue_own[pool], 1u);
    }
    workgroupBarrier();
    if lane < VTEX_QUEUE_POOLS {
        let own = atomicLoad(&vtex_queue_own[lane]);
        if own != 0u {
            let taken = atomicAdd(&vtex_queue_tallies[VTEX_QUEUE_POOLS + lane], own);
            vtex_queue_places[lane] = vtex_queue_parts[lane].first + taken;
        }
    }
    workgroupBarrier();
    if is_there {
        if pool < vtex_queue_parts[0].pools {
            vtex_queue_order[vtex_queue_places[pool] + place] = index;
        } else {
            // No pool, no texture.
            vtex_queue_colors[index] = vec4f();
        }
    }
}
