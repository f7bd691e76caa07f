//!use core/layout
//!use vtex/samples
// An outline whose last command names two paints: its own, and one behind it that fills the cell. Only
// lookups of points have such entries, so all samples see one of the two.

// What an entry with this tag shows.
struct VtexBackdrop {
    tag: u32,
    covered: u32,
}

// `covered`: the samples that the entry's outline covers, which says nothing of those not in `live`.
fn vtex_backdrop(tag: u32, covered: u32, live: u32) -> VtexBackdrop {
    let has = (tag & VTEX_CMD_BACKDROP_BIT) != 0u;
    let shift = select(VTEX_CMD_BACKDROP_SHIFT, 0u, (covered & live) != 0u);
    let index = (tag >> shift) & VTEX_CMD_BACKDROP_MASK;
    let shown = (tag & ~VTEX_CMD_INDEX_MASK) | index;
    return VtexBackdrop(select(tag, shown, has), select(covered, VTEX_SAMPLES_EVERY, has));
}
