//! Twin of `vtex/edge_*.wgsl`, `vtex/msdf_edge.wgsl`, `vtex/ring_*.wgsl` and `vtex/outline.wgsl`: the
//! samples that an entry or its ring covers.

use super::samples::Samples;
use super::{Sampler, msdf};
use crate::layout::cmd;

/// The windings about the outline of the entry that a walk is at.
pub(super) struct Edge<S: Samples> {
    winding: S::Winding,
}

impl<S: Samples> Edge<S> {
    pub(super) fn new() -> Self {
        Self {
            winding: S::Winding::default(),
        }
    }

    /// A command of the entry.
    pub(super) fn wind(&mut self, samples: &S, command: [u32; 4]) {
        samples.wind(&mut self.winding, command);
    }

    /// The samples that the entry with this last command covers; the next entry begins. Of those
    /// that are not in `live` nothing is said.
    pub(super) fn covered(
        &mut self,
        sampler: &Sampler<'_>,
        samples: &S,
        command: [u32; 4],
        live: u32,
    ) -> u32 {
        let winding = std::mem::take(&mut self.winding);
        match command[3] & cmd::KIND_MASK {
            cmd::CURVES => samples.filled(winding, command[3]),
            cmd::MSDF => within(sampler, samples, command[0], 0.0, live),
            _ => u32::MAX,
        }
    }
}

/// The samples in the ring around an MSDF entry, \[SFG22\] eq. 2.
pub(super) fn ring<S: Samples>(
    sampler: &Sampler<'_>,
    samples: &S,
    command: [u32; 4],
    covered: u32,
    live: u32,
) -> u32 {
    let s = &sampler.settings;
    if !s.outline || command[3] & cmd::KIND_MASK != cmd::MSDF {
        return 0;
    }
    within(
        sampler,
        samples,
        command[0],
        -s.outline_width,
        live & !covered,
    ) & !covered
}

/// The samples of `live` whose distance, inside positive, is greater than `least`.
fn within<S: Samples>(sampler: &Sampler<'_>, samples: &S, tile: u32, least: f32, live: u32) -> u32 {
    let mut mask = 0;
    let mut rest = live;
    while rest != 0 {
        let bit = rest & rest.wrapping_neg();
        let q = samples.q(rest.trailing_zeros());
        if msdf::distance(sampler, tile, q) > least {
            mask |= bit;
        }
        rest &= !bit;
    }
    mask
}

/// The samples for which a branch or jump with this tag is taken, when it covers `covered`.
pub(super) const fn taken(tag: u32, covered: u32) -> u32 {
    if tag & cmd::OPAQUE_BIT != 0 {
        covered
    } else {
        !covered
    }
}

/// Where a walk ends: behind every command.
pub(super) const BEYOND: u32 = u32::MAX;

/// Where a control command branches to, when `next` follows it.
pub(super) const fn target(tag: u32, next: u32) -> u32 {
    match tag & cmd::INDEX_MASK {
        0 => BEYOND,
        over => next.wrapping_add(over.wrapping_mul(cmd::WORDS)),
    }
}

/// Whether a control command with this tag is a branch or a jump.
pub(super) const fn is_branch(tag: u32) -> bool {
    let op = tag & cmd::CONTROL_MASK;
    tag & cmd::KIND_MASK == cmd::CURVES || op == cmd::JUMP
}
