//! The commands that evaluators walk for a list.

use super::clip::{Clip, Goal};
use super::group::Group;
use super::hash;
use super::list::{Arena, Node, Part};
use super::outline::{Outline, Outlines, Segment, Span};
use crate::layout::cmd;

/// The last command of an entry holds a base winding of four bits.
const BASE_LIMIT: i32 = 8;
/// Lower end of the line that stands for a change of the winding: below every lookup.
const LOWEST: u32 = 0xffff;

/// In which order blocks beside each other lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// For evaluators that stop at what hides the rest.
    FrontToBack,
    /// For those that composite groups: each needs what lies behind it first.
    BackToFront,
}

/// Appends the commands of a list, four words each.
pub(super) fn write(arena: &Arena, nodes: Span, order: Order, commands: &mut Vec<[u32; 4]>) {
    let first = commands.len();
    let (nodes, backdrop) = match order {
        Order::FrontToBack => split(arena, nodes),
        Order::BackToFront => (&arena.nodes[nodes.range()], 0),
    };
    let mut writer = Writer {
        arena,
        commands,
        branches: Vec::new(),
        order,
    };
    writer.nodes(nodes);
    writer.branch();
    if let Some(last) = commands[first..].last_mut() {
        last[3] |= cmd::LAST_BIT | backdrop;
    }
}

/// What of a list has entries of its own, and the bits of the last of them that stand for the rest: an
/// opaque paint that fills the cell, right behind an opaque outline.
fn split(arena: &Arena, nodes: Span) -> (&[Node], u32) {
    let nodes = &arena.nodes[nodes.range()];
    let [rest @ .., Node::Draw(behind)] = nodes else {
        return (nodes, 0);
    };
    let Some(Node::Draw(front)) = rest.last() else {
        return (nodes, 0);
    };
    let opaque = front.tag & behind.tag & cmd::OPAQUE_BIT != 0;
    let [shown, hidden] = [front, behind].map(|part| part.tag & cmd::INDEX_MASK);
    let short = shown.max(hidden) <= cmd::BACKDROP_MASK;
    if !arena.backdrops || !opaque || !short || front.outline.is_none() || !behind.is_full() {
        return (nodes, 0);
    }
    (rest, cmd::BACKDROP_BIT | hidden << cmd::BACKDROP_SHIFT)
}

struct Writer<'a> {
    arena: &'a Arena,
    commands: &'a mut Vec<[u32; 4]>,
    /// Last commands of entries that branch, and the commands they branch to.
    branches: Vec<(usize, usize)>,
    order: Order,
}

impl Writer<'_> {
    fn body(&mut self, nodes: Span) {
        self.nodes(&self.arena.nodes[nodes.range()]);
    }

    fn nodes(&mut self, nodes: &[Node]) {
        match self.order {
            Order::FrontToBack => nodes.iter().for_each(|node| self.node(node)),
            Order::BackToFront => nodes.iter().rev().for_each(|node| self.node(node)),
        }
    }

    fn node(&mut self, node: &Node) {
        match node {
            Node::Draw(part) => self.draw(part),
            Node::Clip(clip) => self.clip(*clip),
            Node::Group(group) => self.group(*group),
        }
    }

    fn draw(&mut self, part: &Part) {
        match &part.outline {
            None => self.commands.push([part.data, 0, 0, part.tag]),
            Some(outline) => self.outline(outline, part.tag),
        }
    }

    /// The commands of an outline, of which the last carries `tag`.
    fn outline(&mut self, outline: &Outline, tag: u32) {
        let first = self.commands.len();
        let outlines = &self.arena.outlines;
        let lines = lines(outlines, outline);
        self.commands.extend(lines);
        let segments = outlines.segments(outline);
        self.commands.extend(segments.map(|segment| segment.0));
        if self.commands.len() == first {
            self.commands.push([0; 4]);
        }
        if let Some(end) = self.commands.last_mut() {
            end[3] |= tag | end_bits(outline);
        }
    }

    fn clip(&mut self, clip: Clip) {
        let mut places = Vec::new();
        let mut ends = Vec::new();
        let branches = clip.branches(self.arena);
        for branch in branches {
            places.push(self.commands.len());
            let inside = if branch.inside { cmd::OPAQUE_BIT } else { 0 };
            let tag = cmd::END_BIT | cmd::CONTROL_BIT | inside;
            match &branch.outline {
                None => self.commands.push([0, 0, 0, cmd::JUMP | tag]),
                Some(outline) => self.outline(outline, cmd::CURVES | tag),
            }
            ends.push(self.commands.len() - 1);
        }
        let body = self.commands.len();
        self.body(clip.body);
        let end = self.commands.len();
        for (branch, last) in branches.iter().zip(ends) {
            let target = match branch.to {
                Goal::Branch(place) => places[place],
                Goal::Body => body,
                Goal::End => end,
            };
            self.branches.push((last, target));
        }
    }

    fn group(&mut self, group: Group) {
        let mut masks = Vec::new();
        for mask in group.masks(self.arena) {
            self.control([1, 0, 0], cmd::OPEN);
            self.body(mask.body);
            masks.push(self.commands.len());
            self.control([mask.kind, 0, 0], cmd::MASK);
        }
        let isolated = u32::from(group.isolated);
        self.control([isolated, 0, 0], cmd::OPEN);
        self.body(group.body);
        self.control([group.opacity, group.mode, isolated], cmd::CLOSE);
        let end = self.commands.len();
        self.branches
            .extend(masks.into_iter().map(|mask| (mask, end)));
    }

    fn control(&mut self, [x, y, z]: [u32; 3], op: u32) {
        let tag = cmd::END_BIT | cmd::CONTROL_BIT | op;
        self.commands.push([x, y, z, tag]);
    }

    fn branch(self) {
        let count = self.commands.len();
        for (from, to) in self.branches {
            let over = if to < count { to - from - 1 } else { 0 };
            let over = u32::try_from(over).unwrap_or(0) & cmd::INDEX_MASK;
            self.commands[from][3] |= over;
        }
    }
}

/// What the last command of an outline says of it.
fn end_bits(outline: &Outline) -> u32 {
    let base = stored_base(outline);
    let base = (base.cast_unsigned() << cmd::BASE_RIGHT) >> cmd::BASE_LEFT;
    let rule = if outline.even_odd {
        cmd::EVEN_ODD_BIT
    } else {
        0
    };
    base | rule
}

fn stored_base(outline: &Outline) -> i32 {
    outline.base.clamp(-BASE_LIMIT, BASE_LIMIT - 1)
}

/// The lines that stand for changes of the winding beside an outline's segments, and for what of it the
/// last command's base cannot hold.
fn lines<'a>(
    outlines: &'a Outlines,
    outline: &Outline,
) -> impl Iterator<Item = [u32; 4]> + use<'a> {
    let excess = outline.base - stored_base(outline);
    let changes = outlines.changes(outline).iter().copied();
    let all = std::iter::once((0, excess)).chain(changes);
    all.flat_map(|(height, change)| {
        let points = [height << 16, height << 16, LOWEST << 16];
        let Segment(line) = Segment::new(points, change > 0, true);
        (0..change.unsigned_abs()).map(move |_| line)
    })
}

/// How many commands [`write`] makes of a list without clips and groups, and their hash.
pub(super) fn summary(arena: &Arena, nodes: Span) -> (usize, u64) {
    let (nodes, backdrop) = split(arena, nodes);
    let (mut count, mut all) = (0, hash::mix(hash::START, u64::from(backdrop)));
    for node in nodes {
        let Node::Draw(part) = node else { continue };
        let Some(outline) = &part.outline else {
            count += 1;
            all = hash::mix(all, u64::from(part.tag) << 32 | u64::from(part.data));
            continue;
        };
        let (mut own, segments) = outline.summary();
        all = hash::mix(all, segments);
        for line in lines(&arena.outlines, outline) {
            own += 1;
            all = hash::mix(all, hash::of(line));
        }
        count += own.max(1);
        all = hash::mix(all, u64::from(part.tag | end_bits(outline)));
    }
    (count, all)
}
