//! Twin of `vtex/walk.wgsl`, `vtex/hit_*.wgsl` and `vtex/answer.wgsl`: the walk over a cell's list, front to back.
//!
//! All samples of one walk have met the same entries so far, so one colour stands for them. Those
//! that an opaque entry covers are done. At any other entry or test the samples part: the walk goes
//! on with those that do as the first of them does, and another walk begins with the rest.

use vtex_format::Features;

use super::color;
use super::cost::Observer;
use super::edge::{Edge, jumps, ring, target};
use super::math::to_f32;
use super::samples::Samples;
use super::source::{Shown, source};
use super::{Lookup, Sampler, paint};
use crate::layout::cmd;

/// What samples see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer {
    /// The sum of their colours, in linear light, premultiplied.
    pub(super) sum: [f32; 4],
    /// The samples.
    pub(super) done: u32,
}

impl Answer {
    /// Samples that all see `color`.
    pub(super) fn of(color: [f32; 4], samples: u32) -> Self {
        let count = to_f32(samples.count_ones());
        Self {
            sum: color.map(|channel| count * channel),
            done: samples,
        }
    }
}

/// What a list of draws and tests shows to the samples of `live`, or to some of them.
pub(super) fn walk<S: Samples>(
    sampler: &Sampler<'_>,
    lookup: &Lookup,
    first: u32,
    samples: &S,
    live: u32,
    observer: &mut impl Observer,
) -> Answer {
    // The texels of an image may have any alpha.
    let translucent = Features::TRANSLUCENT | Features::IMAGES;
    let mut hit = Hit::new(live, sampler.settings.has(translucent));
    let mut edge = Edge::<S>::new();
    let mut at = first;
    for _ in 0..cmd::LIMIT {
        if hit.live == 0 || sampler.is_past(at) {
            break;
        }
        let words: [u32; 4] = sampler.words(at);
        at = at.wrapping_add(cmd::WORDS);
        edge.wind(samples, words);
        observer.command(words[3]);
        if words[3] & cmd::END_BIT == 0 {
            continue;
        }
        let tail = words[3];
        let covered = edge.covered(sampler, samples, words, hit.live);
        if tail & cmd::CONTROL_BIT != 0 {
            if hit.part(jumps(tail, covered)) {
                at = target(tail, at);
                continue;
            }
        } else {
            hit.draw(sampler, lookup, samples, covered, tail, observer);
            let ring = ring(sampler, samples, words, covered, hit.live);
            let head = sampler.settings.outline_head;
            hit.draw(sampler, lookup, samples, ring, head, observer);
        }
        if tail & cmd::LAST_BIT != 0 {
            break;
        }
    }
    hit.finish()
}

/// What the samples of a walk have met.
struct Hit {
    /// The samples that the walk goes on with.
    live: u32,
    /// Whether translucent paints may be met: of opaque ones all samples share what they share in
    /// any walk.
    restarts: bool,
    /// Whether an entry that hides what lies behind it has left some samples out.
    split: bool,
    /// Those that are done, and their colours.
    answer: Answer,
    /// Entries met, and the last of them where it is the only one.
    count: u32,
    only: [f32; 4],
    /// Of all met, sRGB-encoded, premultiplied.
    color: [f32; 4],
}

impl Hit {
    const fn new(live: u32, restarts: bool) -> Self {
        Self {
            live,
            restarts,
            split: false,
            answer: Answer {
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
        head: u32,
        observer: &mut impl Observer,
    ) {
        let hit = covered & self.live;
        if hit == 0 {
            return;
        }
        observer.paint(head);
        let opaque = head & cmd::OPAQUE_BIT != 0;
        let uv = samples.uv(hit);
        // An opaque paint alone needs no transfer function.
        if opaque && self.count == 0 && head & cmd::KIND_MASK != cmd::IMAGE {
            let color = paint::linear(sampler, head & cmd::INDEX_MASK, uv);
            self.hide(color, hit);
            return;
        }
        let shown = source(sampler, head, uv, lookup);
        // An opaque image shows nothing, and hides nothing, outside its rectangle.
        if opaque && shown.encoded[3] > 0.0 {
            let before = (self.count, self.only, self.color);
            self.take(&shown);
            let color = self.value();
            self.hide(color, hit);
            (self.count, self.only, self.color) = before;
            return;
        }
        let live = self.live;
        if self.part(hit) {
            self.take(&shown);
            if self.color[3] >= 1.0 {
                self.live = live;
                self.hide(self.value(), hit);
                self.live = 0;
            }
        }
    }

    /// Front to back.
    fn take(&mut self, shown: &Shown) {
        if shown.encoded[3] > 0.0 {
            self.count += 1;
            self.only = shown.linear;
            let through = 1.0 - self.color[3];
            self.color = std::array::from_fn(|i| self.color[i] + through * shown.encoded[i]);
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
        self.end(color, those);
    }

    /// Samples are done.
    fn end(&mut self, color: [f32; 4], those: u32) {
        let answer = Answer::of(color, those);
        self.answer.sum = std::array::from_fn(|i| self.answer.sum[i] + answer.sum[i]);
        self.answer.done |= those;
        self.live &= !those;
    }

    fn finish(mut self) -> Answer {
        if self.live != 0 {
            self.end(self.value(), self.live);
        }
        self.answer
    }
}
