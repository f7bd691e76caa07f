//!use core/layout
//!use vtex/frames
// How a walk goes on at tests where edges are hard.

fn vtex_flow_tests(tail: u32) -> bool {
    let op = tail & VTEX_ITEM_CONTROL_MASK;
    return (tail & VTEX_ITEM_KIND_MASK) == VTEX_ITEM_CURVES || op == VTEX_ITEM_JUMP;
}
