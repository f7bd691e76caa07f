//! Twin of `vtex/walk.wgsl`, `vtex/composite_*.wgsl` and `vtex/resolved.wgsl`: the walk over a
//! cell's list, front to back.
//!
//! All samples of one walk have met the same entries so far, so one colour stands for them. Those
//! that an opaque entry covers are done. At any other entry or branch the samples part: the walk
//! goes on with those that do as the first of them does, and another walk begins with the rest.

use vtex_format::Features;

use super::backdrop::backdrop;
use super::brush::{self, BrushColor};
use super::color;
use super::cost::Observer;
use super::edge::{Edge, ring, taken, target};
use super::math::to_f32;
use super::samples::Samples;
use super::{Lookup, Sampler, paint};
use crate::layout::cmd;

/// What samples see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resolved {
    /// The sum of their colours, in linear light, premultiplied.
    pub(super) sum: [f32; 4],
    /// The samples.
    pub(super) done: u32,
}

impl Resolved {
    /// Samples that all see `color`.
    pub(super) fn of(color: [f32; 4], samples: u32) -> Self {
        let count = to_f32(samples.count_ones());
        Self {
            sum: color.map(|channel| count * channel),
            done: samples,
        }
    }
}

/// What a list of draws and branches shows to the samples of `live`, or to some of them.
pub(super) fn walk<S: Samples>(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    first: u32,
    samples: &S,
    live: u32,
    observer: &mut impl Observer,
) -> Resolved {
    // The texels of an image may have any alpha.
    let translucent = Features::TRANSLUCENT | Features::IMAGES;
    let mut composite = Composite::new(live, sampler.settings.has(translucent));
    // Solid paints are the same for samples of whatever walk.
    if !composite.restarts && sampler.settings.has(Features::GRADIENTS) {
        composite.entries = 2;
    }
    let mut edge = Edge::<S>::new();
    let mut at = first;
    for _ in 0..cmd::LIMIT {
        if composite.live == 0 || sampler.is_past(at) {
            break;
        }
        let words: [u32; 4] = sampler.words(at);
        at = at.wrapping_add(cmd::WORDS);
        edge.wind(samples, words);
        observer.command(words[3]);
        if words[3] & cmd::END_BIT == 0 {
            continue;
        }
        let tag = words[3];
        let covered = edge.covered(sampler, samples, words, composite.live);
        if tag & cmd::CONTROL_BIT != 0 {
            if composite.part(taken(tag, covered)) {
                at = target(tag, at);
                continue;
            }
        } else {
            let (shown, met) = backdrop(tag, covered, composite.live);
            composite.draw(sampler, lookup, samples, met, shown, observer);
            let ring = ring(sampler, samples, words, covered, composite.live);
            let tag = sampler.settings.outline_tag;
            composite.draw(sampler, lookup, samples, ring, tag, observer);
        }
        if tag & cmd::LAST_BIT != 0 {
            break;
        }
    }
    composite.resolve()
}

/// What the samples of a walk have met.
struct Composite {
    /// The samples that the walk goes on with.
    live: u32,
    /// Whether translucent paints may be met.
    restarts: bool,
    /// Where all paints are opaque: after how many entries that samples meet the walk ends. Those that
    /// are left take another walk, with others beside them, and samples of one walk that meet one entry
    /// share a place in a gradient.
    entries: u32,
    /// Whether an entry that hides what lies behind it has left some samples out.
    split: bool,
    /// Those that are done, and their colours.
    resolved: Resolved,
    /// Entries met, and the last of them where it is the only one.
    count: u32,
    only: [f32; 4],
    /// Of all met, sRGB-encoded, premultiplied.
    color: [f32; 4],
}

impl Composite {
    const fn new(live: u32, restarts: bool) -> Self {
        Self {
            live,
            restarts,
            entries: u32::MAX,
            split: false,
            resolved: Resolved {
                sum: [0.0; 4],
                done: 0,
            },
            count: 0,
            only: [0.0; 4],
            color: [0.0; 4],
        }
    }

    /// The walk goes on with the samples that do as the first of them does; whether that one is
    /// among `those`.
    fn part(&mut self, those: u32) -> bool {
        let first = 1 << self.live.trailing_zeros();
        let among = those & first != 0;
        self.live &= if among { those } else { !those };
        among
    }

    /// An entry, or its ring, that covers some samples.
    fn draw<S: Samples>(
        &mut self,
        sampler: &Sampler<'_>,
        lookup: &Lookup,
        samples: &S,
        covered: u32,
        tag: u32,
        observer: &mut impl Observer,
    ) {
        let met = brush::covered(sampler, samples, tag, covered & self.live);
        if met == 0 {
            return;
        }
        observer.paint(tag);
        let opaque = tag & cmd::OPAQUE_BIT != 0;
        let uv = samples.uv(met);
        // An opaque paint alone needs no transfer function.
        if opaque && self.count == 0 && tag & cmd::KIND_MASK != cmd::IMAGE {
            let color = paint::linear(sampler, tag & cmd::INDEX_MASK, uv);
            self.hide(color, met);
            return;
        }
        let brush = brush::brush(sampler, tag, uv, lookup);
        if opaque {
            let before = (self.count, self.only, self.color);
            self.take(&brush);
            let color = self.value();
            self.hide(color, met);
            (self.count, self.only, self.color) = before;
            return;
        }
        let live = self.live;
        if self.part(met) {
            self.take(&brush);
            if self.color[3] >= 1.0 {
                self.live = live;
                self.hide(self.value(), met);
                self.live = 0;
            }
        }
    }

    /// Front to back.
    fn take(&mut self, brush: &BrushColor) {
        if brush.encoded[3] > 0.0 {
            self.count += 1;
            self.only = brush.linear;
            let through = 1.0 - self.color[3];
            self.color = std::array::from_fn(|i| self.color[i] + through * brush.encoded[i]);
        }
    }

    /// What the samples see that meet nothing more.
    fn value(&self) -> [f32; 4] {
        // A single one needs no transfer function where its linear light is known.
        if self.count <= 1 && self.only[3] >= 0.0 {
            self.only
        } else {
            color::decode_premultiplied(self.color)
        }
    }

    /// Nothing behind an entry shows to samples. A walk ends where an entry leaves some out for a
    /// second time, and all that are left take another one: that decides which samples share a colour.
    fn hide(&mut self, color: [f32; 4], those: u32) {
        if self.restarts && those != self.live {
            if self.split {
                self.live = 0;
                return;
            }
            self.split = true;
        }
        if self.entries == 0 {
            self.live = 0;
            return;
        }
        self.entries -= 1;
        self.end(color, those);
    }

    /// Samples are done.
    fn end(&mut self, color: [f32; 4], those: u32) {
        let resolved = Resolved::of(color, those);
        self.resolved.sum = std::array::from_fn(|i| self.resolved.sum[i] + resolved.sum[i]);
        self.resolved.done |= those;
        self.live &= !those;
    }

    fn resolve(mut self) -> Resolved {
        if self.live != 0 {
            self.end(self.value(), self.live);
        }
        self.resolved
    }
}
