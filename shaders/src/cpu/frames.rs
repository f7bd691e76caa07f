//! Twin of `vtex/frames.wgsl`: what a walk keeps of the groups and clips that it is in.

use vtex_format::MAX_FRAMES;

#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Of a group what lies behind it; of jumps their colours, each times its share.
    pub(super) color: [f32; 4],
    /// The item at which jumps end; 0 for a group.
    pub(super) ends: u32,
    /// Of jumps theirs; of a group that with which the walk came to it.
    pub(super) share: f32,
    /// What a group's masks make of its opacity.
    pub(super) weight: f32,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Frames {
    /// Premultiplied; sRGB-encoded, or in linear light where edges are ramps.
    pub(super) color: [f32; 4],
    /// Of the lookup's footprint, since the innermost group began: the rest has jumped.
    pub(super) share: f32,
    /// Of masks whose group has not begun.
    pub(super) weight: f32,
    /// As of the innermost frame; 0 without one.
    pub(super) ends: u32,
    depth: usize,
    /// Invariant: between two groups the inner frames end first.
    list: [Frame; MAX_FRAMES as usize],
}

impl Frames {
    pub(super) const fn new() -> Self {
        let nothing = Frame {
            color: [0.0; 4],
            ends: 0,
            share: 0.0,
            weight: 0.0,
        };
        Self {
            color: [0.0; 4],
            share: 1.0,
            weight: 1.0,
            ends: 0,
            depth: 0,
            list: [nothing; MAX_FRAMES as usize],
        }
    }

    /// Leaves the innermost frame, `None` without one: no walk over sound words gets there.
    pub(super) fn pop(&mut self) -> Option<Frame> {
        self.depth = self.depth.checked_sub(1)?;
        let outer = self.depth.checked_sub(1).map(|outer| self.list[outer]);
        self.ends = outer.map_or(0, |outer| outer.ends);
        Some(self.list[self.depth])
    }

    /// Enters a group, unless there are as many frames as can be.
    pub(super) fn push_group(&mut self) {
        let Some(frame) = self.list.get_mut(self.depth) else {
            return;
        };
        *frame = Frame {
            color: self.color,
            ends: 0,
            share: self.share,
            weight: self.weight,
        };
        self.depth += 1;
        self.ends = 0;
    }

    /// Keeps a share of the lookup until the item `ends`. Twin of `vtex_flow_wait`.
    pub(super) fn wait(&mut self, share: f32, ends: u32) {
        let color = self.color.map(|channel| share * channel);
        let mut place = self.depth;
        while place > 0 {
            let outer = self.list[place - 1].ends;
            if outer == 0 || outer >= ends {
                break;
            }
            place -= 1;
        }
        if let Some(same) = place.checked_sub(1).map(|outer| &mut self.list[outer])
            && same.ends == ends
        {
            same.color = std::array::from_fn(|i| same.color[i] + color[i]);
            same.share += share;
            return;
        }
        if self.depth == self.list.len() {
            return;
        }
        self.list.copy_within(place..self.depth, place + 1);
        self.list[place] = Frame {
            color,
            ends,
            share,
            weight: 0.0,
        };
        self.ends = self.list[self.depth].ends;
        self.depth += 1;
    }
}
