//!use core/layout
//!use vtex/frames
// How a walk goes on at tests where edges are ramps: a share of the lookup jumps with the colour as
// it is, and where jump and walk meet the colours are averaged by their shares.

// Whether a control item with this last word is a test or a jump.
fn vtex_flow_tests(tail: u32) -> bool {
    let op = tail & VTEX_ITEM_CONTROL_MASK;
    return (tail & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_CURVES || op == VTEX_ITEM_JUMP;
}

// Takes in the jumps that end at the item `at`.
fn vtex_flow_arrive(frames: ptr<function, VtexFrames>, at: u32) {
    if (*frames).ends != at {
        return;
    }
    let jumps = vtex_frames_pop(frames);
    let share = (*frames).share + jumps.share;
    (*frames).color = ((*frames).share * (*frames).color + jumps.color) / share;
    (*frames).share = share;
}

// The item to go on with, when a part `jumps` goes on at `ends` and the rest at `next`.
fn vtex_flow_test(frames: ptr<function, VtexFrames>, jumps: f32, next: u32, ends: u32) -> u32 {
    if jumps <= 0.0 {
        return next;
    }
    let alone = (*frames).ends == 0u || ends <= (*frames).ends;
    if jumps >= 1.0 && alone {
        return ends;
    }
    vtex_flow_wait(frames, (*frames).share * jumps, ends);
    (*frames).share *= 1.0 - jumps;
    return select((*frames).ends, next, (*frames).share > 0.0);
}

// Keeps a share of the lookup until the item `ends`.
fn vtex_flow_wait(frames: ptr<function, VtexFrames>, share: f32, ends: u32) {
    let color = share * (*frames).color;
    var place = (*frames).depth;
    for (var i = 0u; i < VTEX_KEY_FRAMES; i += 1u) {
        if place == 0u {
            break;
        }
        let outer = (*frames).list[place - 1u].ends;
        if outer == 0u || outer >= ends {
            break;
        }
        place -= 1u;
    }
    if place > 0u && (*frames).list[place - 1u].ends == ends {
        (*frames).list[place - 1u].color += color;
        (*frames).list[place - 1u].share += share;
        return;
    }
    for (var i = 0u; i < VTEX_KEY_FRAMES; i += 1u) {
        let free = (*frames).depth - i;
        if free <= place {
            break;
        }
        (*frames).list[free] = (*frames).list[free - 1u];
    }
    (*frames).list[place] = VtexFrame(color, ends, share, 0.0);
    (*frames).ends = (*frames).list[(*frames).depth].ends;
    (*frames).depth += 1u;
}
