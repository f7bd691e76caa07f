//! Twin of `vtex/backdrop.wgsl`: an outline whose last command names two paints.

use crate::layout::cmd;

/// The tag and the samples of what an entry shows whose outline covers `covered`, which says nothing of
/// samples that are not in `live`.
pub(super) const fn backdrop(tag: u32, covered: u32, live: u32) -> (u32, u32) {
    if tag & cmd::BACKDROP_BIT == 0 {
        return (tag, covered);
    }
    let shift = if covered & live != 0 {
        0
    } else {
        cmd::BACKDROP_SHIFT
    };
    let index = tag >> shift & cmd::BACKDROP_MASK;
    (tag & !cmd::INDEX_MASK | index, u32::MAX)
}
