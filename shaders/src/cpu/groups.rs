//! Twin of `vtex/groups.wgsl`: lists that hold groups, whose commands lie back to front. One walk,
//! sRGB-encoded, with what lies behind each open group on a blend stack.

use vtex_format::MAX_BLEND_DEPTH;

use super::blend::blend;
use super::brush;
use super::color::decode_premultiplied;
use super::cost::Observer;
use super::edge::{BEYOND, Edge, is_branch, taken, target};
use super::samples::Samples;
use super::walk::Resolved;
use super::{Lookup, Sampler};
use crate::layout::{cmd, mask};

/// What the list shows to those samples of `live` that do at every edge as the first of them does.
pub(super) fn groups<S: Samples>(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    first: u32,
    samples: &S,
    mut live: u32,
    observer: &mut impl Observer,
) -> Resolved {
    let leader = 1 << live.trailing_zeros();
    let mut stack = BlendStack::new();
    let mut edge = Edge::<S>::new();
    let mut at = first;
    for _ in 0..cmd::LIMIT {
        if sampler.is_past(at) {
            break;
        }
        let words: [u32; 4] = sampler.words(at);
        let tag = words[3];
        at = at.wrapping_add(cmd::WORDS);
        edge.wind(samples, words);
        observer.command(tag);
        if tag & cmd::END_BIT == 0 {
            continue;
        }
        let covered = edge.covered(sampler, samples, words, live);
        let next = at;
        if tag & cmd::LAST_BIT != 0 {
            at = BEYOND;
        }
        if tag & cmd::CONTROL_BIT != 0 {
            let branches = if is_branch(tag) {
                let taken = taken(tag, covered);
                let leads = taken & leader != 0;
                live &= if leads { taken } else { !taken };
                leads
            } else {
                stack.control(words)
            };
            if branches {
                at = target(tag, next);
            }
            continue;
        }
        let drawn = brush::covered(sampler, samples, tag, covered);
        if drawn & leader != 0 {
            live &= drawn;
            observer.paint(tag);
            let brush = brush::brush(sampler, tag, samples.uv(live), lookup).encoded;
            let through = 1.0 - brush[3];
            stack.color = std::array::from_fn(|i| brush[i] + through * stack.color[i]);
        } else {
            live &= !drawn;
        }
    }
    Resolved::of(decode_premultiplied(stack.color), live)
}

/// A level of the blend stack: an open group or mask.
#[derive(Clone, Copy, Debug)]
struct BlendLevel {
    /// What lies behind it.
    color: [f32; 4],
    /// What its masks make of its opacity.
    weight: f32,
}

/// The colour so far and what lies behind the open groups; all sRGB-encoded, premultiplied.
struct BlendStack {
    color: [f32; 4],
    /// Of masks whose group has not begun.
    weight: f32,
    depth: usize,
    levels: [BlendLevel; MAX_BLEND_DEPTH as usize],
}

impl BlendStack {
    const fn new() -> Self {
        let nothing = BlendLevel {
            color: [0.0; 4],
            weight: 0.0,
        };
        Self {
            color: [0.0; 4],
            weight: 1.0,
            depth: 0,
            levels: [nothing; MAX_BLEND_DEPTH as usize],
        }
    }

    /// Whether the walk branches over what follows the control command.
    fn control(&mut self, command: [u32; 4]) -> bool {
        match command[3] & cmd::CONTROL_MASK {
            cmd::OPEN => {
                self.open(command[0] != 0);
                false
            }
            cmd::CLOSE => {
                self.close(command);
                false
            }
            _ => self.mask(command[0]),
        }
    }

    fn open(&mut self, isolated: bool) {
        // No list that a validator lets in has more groups.
        if let Some(level) = self.levels.get_mut(self.depth) {
            *level = BlendLevel {
                color: self.color,
                weight: self.weight,
            };
            self.depth += 1;
        }
        self.weight = 1.0;
        if isolated {
            self.color = [0.0; 4];
        }
    }

    fn pop(&mut self) -> Option<BlendLevel> {
        self.depth = self.depth.checked_sub(1)?;
        Some(self.levels[self.depth])
    }

    fn close(&mut self, command: [u32; 4]) {
        let group = self.color;
        let Some(level) = self.pop() else {
            return;
        };
        let weight = f32::from_bits(command[0]) * level.weight;
        self.color = if command[2] != 0 {
            over(command[1], level.color, group.map(|c| weight * c))
        } else if weight >= 1.0 {
            group
        } else {
            std::array::from_fn(|i| (1.0 - weight) * level.color[i] + weight * group[i])
        };
    }

    fn mask(&mut self, kind: u32) -> bool {
        let content = self.color;
        let value = match kind {
            mask::LUMINANCE => luminance(content),
            mask::LINEAR_LUMINANCE => luminance(decode_premultiplied(content)),
            _ => content[3],
        };
        let Some(level) = self.pop() else {
            return false;
        };
        self.color = level.color;
        let weight = level.weight * value;
        let nothing = weight <= 0.0;
        self.weight = if nothing { 1.0 } else { weight };
        nothing
    }
}

/// An isolated group over what lies behind it.
fn over(mode: u32, behind: [f32; 4], group: [f32; 4]) -> [f32; 4] {
    // Where one side alone shows, no mode changes it.
    if group[3] <= 0.0 {
        return behind;
    }
    if behind[3] <= 0.0 {
        return group;
    }
    blend(mode, behind, group)
}

/// Coefficients of Rec. 709, as resvg has them.
fn luminance([r, g, b, _]: [f32; 4]) -> f32 {
    r * 0.2126 + g * 0.7152 + b * 0.0722
}
