//! Twin of `vtex/run_winding.wgsl`, `vtex/run_distance.wgsl` and `vtex/curve.wgsl`: the items of
//! one entry.

use super::math::to_f32;
use super::{Sampler, segment};
use crate::layout::item::{BASE_LEFT, BASE_RIGHT, END_BIT, EVEN_ODD_BIT, GHOST_BIT, LIMIT, WORDS};

#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    /// The entry's last item and what follows it.
    pub(super) item: [u32; 4],
    pub(super) next: u32,
    pub(super) inside: bool,
    /// To the nearest segment in units, squared; at most the reach.
    pub(super) nearest: f32,
}

/// `q` is the position inside the file's cell. Distances are measured unless `sharp`.
pub(super) fn run(sampler: &Sampler<'_>, first: u32, q: [f32; 2], sharp: bool) -> Run {
    let [units, reach] = sampler.settings.curve_lattice;
    run_at(sampler, first, q.map(|q| q * units + reach), sharp)
}

/// As [`run`] for a place in units of the cell's box.
pub(super) fn run_at(sampler: &Sampler<'_>, first: u32, p: [f32; 2], sharp: bool) -> Run {
    let [_, reach] = sampler.settings.curve_lattice;
    let mut run = Run {
        item: [0; 4],
        next: first,
        inside: false,
        nearest: reach * reach,
    };
    let mut winding = 0;
    for _ in 0..LIMIT {
        run.item = sampler.words(run.next);
        run.next = run.next.wrapping_add(WORDS);
        winding += segment::winding(run.item, p);
        if !sharp && run.item[3] & GHOST_BIT == 0 {
            let distance = segment::distance_squared(run.item, p, run.nearest);
            run.nearest = run.nearest.min(distance);
        }
        if run.item[3] & END_BIT != 0 || sampler.is_past(run.next) {
            break;
        }
    }
    run.inside = fills(run.item[3], winding);
    run
}

fn fills(tail: u32, winding: i32) -> bool {
    let total = winding + ((tail << BASE_LEFT).cast_signed() >> BASE_RIGHT);
    if tail & EVEN_ODD_BIT != 0 {
        total & 1 != 0
    } else {
        total != 0
    }
}

/// In texels, inside positive; far beyond every ramp where no segment is in reach, or when
/// `sharp`.
pub(super) fn texels(sampler: &Sampler<'_>, run: &Run, sharp: bool) -> f32 {
    let settings = &sampler.settings;
    let [units_per_cell, reach] = settings.curve_lattice;
    let units = run.nearest.sqrt();
    // The slack is for square roots that are not correctly rounded.
    let distance = if sharp || units >= reach * 0.999_999 {
        1e9
    } else {
        units / units_per_cell * to_f32(settings.texels_per_cell)
    };
    if run.inside { distance } else { -distance }
}
