//! Twin of `vtex/ramp_any.wgsl` and `vtex/ramp_point.wgsl`: coverage from a signed distance in texels, inside positive.

use super::Sampler;
use super::math::{clamp, smoothstep, to_f32};
use crate::layout::filter::{FOOTPRINT, PAPER};

pub(super) fn coverage(sampler: &Sampler<'_>, distance: f32, width_cells: f32) -> f32 {
    let s = &sampler.settings;
    match s.filter {
        FOOTPRINT => {
            let width = width_cells * to_f32(s.texels_per_cell);
            clamp(distance / width.max(1e-6) + 0.5, 0.0, 1.0)
        }
        PAPER => {
            // [SFG22] eq. 1.
            let m = distance / s.distance_range + 0.5;
            smoothstep(0.5 - s.smoothing, 0.5 + s.smoothing, m)
        }
        _ => f32::from(u8::from(distance > 0.0)),
    }
}
