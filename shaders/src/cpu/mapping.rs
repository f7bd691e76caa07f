//! Twin of `vtex/mapping_inset.wgsl` and `vtex/mapping_any.wgsl`, and so of `vtex/mapping_clamp.wgsl`,
//! which is what it does for the identity and the address mode clamp.

use vtex_format::Features;

use super::Sampler;
use super::math::clamp;
use crate::layout::address::{BORDER, CLAMP, MIRROR, REPEAT};

/// Units along the canvas, at least: without curves there are none.
const LEAST_UNITS: f32 = 131_072.0;

/// In uv: what is smaller is a point.
const LEAST_EXTENT: f32 = 1e-12;

fn linear(m: &[f32; 6], v: [f32; 2]) -> [f32; 2] {
    [m[0] * v[0] + m[2] * v[1], m[1] * v[0] + m[3] * v[1]]
}

pub(super) fn point(sampler: &Sampler<'_>, uv: [f32; 2]) -> [f32; 2] {
    if !sampler.settings.has(Features::MAPPING) {
        return uv;
    }
    let m = &sampler.settings.texture_matrix;
    let [u, v] = linear(m, uv);
    [u + m[4], v + m[5]]
}

pub(super) fn axes(sampler: &Sampler<'_>, axes: [f32; 4]) -> [f32; 4] {
    if !sampler.settings.has(Features::MAPPING) {
        return axes;
    }
    let m = &sampler.settings.texture_matrix;
    let first = linear(m, [axes[0], axes[1]]);
    let second = linear(m, [axes[2], axes[3]]);
    [first[0], first[1], second[0], second[1]]
}

/// Axes in uv, after the matrix. In clamp mode, beyond a side of the canvas all of a footprint shows
/// what the side does. In mirror mode, what is mirrored is so with its footprint.
pub(super) fn kept(sampler: &Sampler<'_>, uv: [f32; 2], mut axes: [f32; 4]) -> [f32; 4] {
    for axis in 0..2 {
        let t = uv[axis];
        let kept: fn(f32) -> f32 = match sampler.settings.address[axis] {
            CLAMP if clamp(t, 0.0, 1.0) != t => |_| 0.0,
            MIRROR if turn(t) > 1.0 => |extent| -extent,
            _ => continue,
        };
        axes[axis] = kept(axes[axis]);
        axes[axis + 2] = kept(axes[axis + 2]);
    }
    axes
}

/// A place in a canvas and its mirrored copy, which follows from 1 to 2.
fn turn(t: f32) -> f32 {
    t - 2.0 * (t * 0.5).floor()
}

fn axis(t: f32, mode: u32) -> f32 {
    match mode {
        REPEAT => t - t.floor(),
        MIRROR => {
            let turn = turn(t);
            if turn > 1.0 { 2.0 - turn } else { turn }
        }
        // Clamped in any mode.
        _ => t,
    }
}

/// How far inside the canvas places are kept, in uv: three halves of a unit of the curve lattice, to
/// which a shape that ends with the canvas is rounded. Its side itself may show what lies behind.
pub(super) fn inset(sampler: &Sampler<'_>, axis: usize) -> f32 {
    let units = sampler.settings.curve_lattice[0] * sampler.settings.scale[axis];
    1.5 / units.max(LEAST_UNITS)
}

pub(super) fn address(sampler: &Sampler<'_>, uv: [f32; 2]) -> [f32; 2] {
    let modes = sampler.settings.address;
    [0, 1].map(|i| {
        let inset = inset(sampler, i);
        clamp(axis(uv[i], modes[i]), inset, 1.0 - inset)
    })
}

/// How much of `extent` about `t` lies within 0 and 1 in border mode.
fn axis_share(t: f32, extent: f32, mode: u32) -> f32 {
    if mode != BORDER {
        1.0
    } else if extent < LEAST_EXTENT {
        if (0.0..=1.0).contains(&t) { 1.0 } else { 0.0 }
    } else {
        // What lies without, so that nothing is lost to rounding where all lies within.
        let outside = (0.5 * extent - t).max(0.0) + (t + 0.5 * extent - 1.0).max(0.0);
        clamp(1.0 - outside / extent, 0.0, 1.0)
    }
}

/// How much of a footprint lies on the canvas in border mode, as if it were upright.
pub(super) fn share(sampler: &Sampler<'_>, uv: [f32; 2], axes: [f32; 4]) -> f32 {
    let modes = sampler.settings.address;
    let wide = sampler.settings.has(Features::FOOTPRINT);
    let [u, v] = [0, 1].map(|i| {
        let extent = if wide {
            axes[i].abs() + axes[i + 2].abs()
        } else {
            0.0
        };
        axis_share(uv[i], extent, modes[i])
    });
    u * v
}

/// Axes along which the filter of image 0 reaches round to the other side.
pub(super) fn wraps(sampler: &Sampler<'_>) -> [bool; 2] {
    sampler.settings.address.map(|mode| mode == REPEAT)
}
