//!use vtex/frames
// How a walk goes on where nothing is clipped.

fn vtex_flow_tests(tail: u32) -> bool {
    return false;
}

fn vtex_flow_arrive(frames: ptr<function, VtexFrames>, at: u32) {
}

fn vtex_flow_test(frames: ptr<function, VtexFrames>, jumps: f32, next: u32, ends: u32) -> u32 {
    return next;
}
