//! Twin of `vtex/paper.wgsl`: the filter of \[SFG22\], as a baseline.

use super::backdrop::backdrop;
use super::brush;
use super::color;
use super::edge::{Edge, taken, target};
use super::math::smoothstep;
use super::samples::Samples;
use super::walk::Resolved;
use super::{Lookup, Sampler, msdf};
use crate::layout::cmd;

/// What a list shows, front to back. The edges of MSDFs are ramps of constant width (eq. 1) with
/// coverage as alpha, and may have a ring (eq. 2); other edges are hard.
pub(super) fn paper<S: Samples>(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    first: u32,
    samples: &S,
) -> Resolved {
    let s = &sampler.settings;
    let mut edge = Edge::<S>::new();
    let mut color = [0.0_f32; 4];
    let mut at = first;
    for _ in 0..cmd::LIMIT {
        if color[3] >= 1.0 || sampler.is_past(at) {
            break;
        }
        let words: [u32; 4] = sampler.words(at);
        let tag = words[3];
        at = at.wrapping_add(cmd::WORDS);
        edge.wind(samples, words);
        if tag & cmd::END_BIT == 0 {
            continue;
        }
        let mut inner = 1.0;
        let mut outer = 0.0;
        let mut shown = tag;
        if tag & cmd::KIND_MASK == cmd::MSDF {
            let distance = msdf::distance(sampler, words[0], samples.centre());
            inner = ramp(sampler, distance);
            if s.outline {
                outer = ramp(sampler, distance + s.outline_width);
            }
        } else {
            let mut covered = edge.covered(sampler, samples, words, 1);
            if tag & cmd::CONTROL_BIT == 0 {
                (shown, covered) = backdrop(tag, covered, 1);
                covered = brush::covered(sampler, samples, shown, covered);
            }
            if covered & 1 == 0 {
                inner = 0.0;
            }
        }
        if tag & cmd::CONTROL_BIT != 0 {
            if taken(tag, u32::from(inner > 0.0)) & 1 != 0 {
                at = target(tag, at);
                continue;
            }
        } else {
            // Shape and ring exclude each other: both lie over what is behind.
            let mut entry = [0.0; 4];
            for (share, tag) in [(inner, shown), ((outer - inner).max(0.0), s.outline_tag)] {
                if share > 0.0 {
                    let brush = brush::brush(sampler, tag, samples.uv(1), lookup).encoded;
                    entry = std::array::from_fn(|i| entry[i] + share * brush[i]);
                }
            }
            let through = 1.0 - color[3];
            color = std::array::from_fn(|i| color[i] + through * entry[i]);
        }
        if tag & cmd::LAST_BIT != 0 {
            break;
        }
    }
    Resolved::of(color::decode_premultiplied(color), 1)
}

/// Eq. 1: a smoothstep of half width S about the edge.
fn ramp(sampler: &Sampler<'_>, distance: f32) -> f32 {
    let s = &sampler.settings;
    let m = distance / s.distance_range + 0.5;
    smoothstep(0.5 - s.smoothing, 0.5 + s.smoothing, m)
}
