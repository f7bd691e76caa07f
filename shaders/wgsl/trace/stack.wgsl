// What a traversal comes back to, in memory of the invocation. The stages have one of their own.

// Depth of the stack, as in obvhs; the host refuses deeper trees.
const STACK_SIZE: u32 = 32u;

alias Stack = array<vec2u, 32>;

fn stack_put(stack: ptr<function, Stack>, place: u32, nodes: vec2u) {
    (*stack)[place] = nodes;
}

fn stack_get(stack: ptr<function, Stack>, place: u32) -> vec2u {
    return (*stack)[place];
}
