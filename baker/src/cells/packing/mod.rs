//! Packing into layers: greedy, and painter's order is kept.
//!
//! An item gets the lowest rank above every earlier item that it meets. Two items meet when their
//! filled regions, as seen inside a window, come within a spacing of each other. By construction
//! members of a rank do not meet, and painter's order is kept wherever it can be seen. The number
//! of ranks is the length of the longest chain of items each of which meets the next; no packing
//! that keeps the order has fewer.

mod packer;
#[cfg(test)]
mod tests;

use kurbo::Rect;

use crate::coverage::{grid::Lattice, placed::Placed, scales::Scales};
use packer::Packer;

/// Ranks of items in painter's order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Packing {
    /// Rank of each item; 0 is the backmost.
    pub(crate) ranks: Vec<u32>,
    /// How many ranks there are.
    pub(crate) count: u32,
    /// Whether a forced merge put items that meet into one rank.
    pub(crate) forced: bool,
}

/// Packs the items of a drawing; `merge` puts all into one rank instead.
pub(crate) fn pack_items(
    placed: &[Placed],
    lattice: &Lattice,
    scales: &Scales,
    merge: bool,
) -> Packing {
    // Shapes of one rank share MSDF tiles and curve records. In a tile no texel may lie within half
    // the range of two shapes, because it stores one distance. In a record shapes only must not overlap;
    // two margins are more than that takes.
    let shapes = || placed.iter().filter(|item| item.is_shape());
    let spacing = if shapes().all(Placed::is_curves) {
        2.0 * scales.distances.margin
    } else {
        scales.range
    };
    // Lookups stay on the canvas, but tiles at its border see outlines up to the spacing beyond it.
    let window = lattice.canvas.inflate(spacing, spacing);
    if merge {
        merge_all(placed, window, spacing)
    } else {
        pack(placed, window, spacing)
    }
}

/// Packs `items`. What lies outside `window` does not count; items within `spacing` steps meet.
fn pack(items: &[Placed], window: Rect, spacing: f64) -> Packing {
    let mut packer = Packer::new(items, window, spacing);
    for index in 0..items.len() {
        packer.add(index);
    }
    // Items that meet nothing inside the window, and clips without anything to clip, are in rank 0 without
    // being its members.
    let count = packer.members.len().max(usize::from(!items.is_empty()));
    Packing {
        count: ranks_to_u32(count),
        ranks: packer
            .ranks
            .iter()
            .map(|&rank| ranks_to_u32(rank))
            .collect(),
        forced: false,
    }
}

/// \[SFG22\]'s "merge all": every item in rank 0, whatever they touch.
fn merge_all(items: &[Placed], window: Rect, spacing: f64) -> Packing {
    Packing {
        ranks: vec![0; items.len()],
        count: u32::from(!items.is_empty()),
        forced: pack(items, window, spacing).count > 1,
    }
}

fn ranks_to_u32(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
