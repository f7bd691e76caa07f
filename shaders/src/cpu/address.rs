//! Twin of `vtex/address_any.wgsl`.

use super::Sampler;
use super::math::clamp;
use crate::layout::address::{BORDER, MIRROR, REPEAT};

fn axis(t: f32, mode: u32) -> f32 {
    match mode {
        REPEAT => t - t.floor(),
        MIRROR => {
            let turn = t - 2.0 * (t * 0.5).floor();
            if turn > 1.0 { 2.0 - turn } else { turn }
        }
        _ => clamp(t, 0.0, 1.0),
    }
}

pub(super) fn address(sampler: &Sampler<'_>, uv: [f32; 2]) -> [f32; 2] {
    let modes = sampler.settings.address;
    [axis(uv[0], modes[0]), axis(uv[1], modes[1])]
}

#[expect(
    clippy::manual_range_contains,
    reason = "what is no number is not outside"
)]
fn axis_outside(t: f32, mode: u32) -> bool {
    mode == BORDER && (t < 0.0 || t > 1.0)
}

pub(super) fn outside(sampler: &Sampler<'_>, uv: [f32; 2]) -> bool {
    let modes = sampler.settings.address;
    axis_outside(uv[0], modes[0]) || axis_outside(uv[1], modes[1])
}

/// Axes along which the filter of image 0 reaches round to the other side.
pub(super) fn wraps(sampler: &Sampler<'_>) -> [bool; 2] {
    sampler.settings.address.map(|mode| mode == REPEAT)
}
