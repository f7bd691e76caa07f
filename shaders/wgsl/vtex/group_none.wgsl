//!use vtex/frames
// A list without groups.

fn vtex_group(frames: ptr<function, VtexFrames>, item: vec4u) -> bool {
    return false;
}
