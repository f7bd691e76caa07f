//!use vtex/key
// What a walk keeps of the groups and clips that it is in.

struct VtexFrame {
    // Of a group what lies behind it; of jumps their colours, each times its share.
    color: vec4f,
    // The item at which jumps end; 0 for a group.
    ends: u32,
    // Of jumps theirs; of a group that with which the walk came to it.
    share: f32,
    // What a group's masks make of its opacity.
    weight: f32,
}

struct VtexFrames {
    // Premultiplied; vtex/tone says how encoded.
    color: vec4f,
    // Of the lookup's footprint, since the innermost group began: the rest has jumped.
    share: f32,
    // Of masks whose group has not begun.
    weight: f32,
    // As of the innermost frame; 0 without one.
    ends: u32,
    depth: u32,
    // Invariant: between two groups the inner frames end first.
    list: array<VtexFrame, VTEX_KEY_FRAMES>,
}

fn vtex_frames_start() -> VtexFrames {
    var frames: VtexFrames;
    frames.share = 1.0;
    frames.weight = 1.0;
    return frames;
}

// Leaves the innermost frame.
fn vtex_frames_pop(frames: ptr<function, VtexFrames>) -> VtexFrame {
    (*frames).depth -= 1u;
    let frame = (*frames).list[(*frames).depth];
    (*frames).ends = 0u;
    if (*frames).depth > 0u {
        (*frames).ends = (*frames).list[(*frames).depth - 1u].ends;
    }
    return frame;
}
