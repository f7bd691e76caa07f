//!use state/paths
// What a traversal comes back to: the first places in memory of the workgroup, the others, which hardly
// any tree is deep enough for, behind the queues. Registers would take two of each place.

// Depth of the stack, as in trace/stack.
const STACK_SIZE: u32 = 32u;
const STACK_NEAR: u32 = 12u;

// While rays are traced no queue has anything in it.
@group(2) @binding(0) var<storage, read_write> stack_far: array<vec2u>;

var<workgroup> stack_near: array<vec2u, 768>;
var<private> stack_lane: u32;
var<private> stack_path: u32;

fn stack_begin(lane: u32, path: u32) {
    stack_lane = lane;
    stack_path = path;
}

// Nothing of it is in memory of the invocation.
alias Stack = u32;

fn stack_put(stack: ptr<function, Stack>, place: u32, nodes: vec2u) {
    if place < STACK_NEAR {
        stack_near[place * 64u + stack_lane] = nodes;
    } else {
        stack_far[(place - STACK_NEAR) * state_room() + stack_path] = nodes;
    }
}

fn stack_get(stack: ptr<function, Stack>, place: u32) -> vec2u {
    if place < STACK_NEAR {
        return stack_near[place * 64u + stack_lane];
    }
    return stack_far[(place - STACK_NEAR) * state_room() + stack_path];
}
