//! The list of a part of a cell.

use vtex_format::{Block, Entry, EntryKind, MAX_ENTRIES_PER_CELL, OPEN_ISOLATED, list_blocks};

use super::clip::{Branch, Clip};
use super::commands::{self, Order};
use super::group::{Group, Mask};
use super::hash;
use super::outline::{Outline, Outlines, Span};
use crate::layout::cmd;

/// An entry that draws, with its outline if it has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Of its last command, without what an outline adds.
    pub(super) tag: u32,
    /// First word of the command without an outline.
    pub(super) data: u32,
    pub(super) outline: Option<Outline>,
}

/// A block of a list, as [`Block`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Node {
    Draw(Part),
    Clip(Clip),
    Group(Group),
}

/// What shows in a region, front to back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct List {
    pub(super) nodes: Span,
    /// The segments of its outlines, perhaps among others.
    places: Span,
    /// Whether a part of the region can have less to show.
    pub(super) has_outlines: bool,
}

/// What the lists of a cell of the file and of its parts are made of. Its memory serves the next cell
/// again.
#[derive(Clone, Debug, Default)]
pub(super) struct Arena {
    pub(super) nodes: Vec<Node>,
    pub(super) branches: Vec<Branch>,
    pub(super) masks: Vec<Mask>,
    pub(super) outlines: Outlines,
    /// Nodes of bodies and lists that are not complete.
    pub(super) pending: Vec<Node>,
    /// Whether there is a clip or group.
    has_controls: bool,
    /// Whether lists end as [`cmd::BACKDROP_BIT`] says.
    pub(super) backdrops: bool,
}

impl Arena {
    pub(super) fn new(backdrops: bool) -> Self {
        Self {
            backdrops,
            ..Self::default()
        }
    }

    /// Forgets all lists.
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.branches.clear();
        self.masks.clear();
        self.outlines.clear();
    }

    /// The list of a whole cell; `words` starts at its first entry.
    pub(super) fn decode(&mut self, words: &[u32], curves: &[u32]) -> List {
        let mut entries = Vec::new();
        for &words in words.as_chunks().0 {
            let Some(entry) = Entry::decode(words) else {
                break;
            };
            entries.push(entry);
            if entry.last || entries.len() == MAX_ENTRIES_PER_CELL as usize {
                break;
            }
        }
        let draws = |at: &usize| entries[*at].kind.draws();
        let ungrouped = || (0..entries.len()).filter(draws).map(Block::Draw).collect();
        // What no validator lets in shows without what clips and groups it.
        let blocks = if (0..entries.len()).all(|at| draws(&at)) {
            ungrouped()
        } else {
            list_blocks(&entries).unwrap_or_else(|_| ungrouped())
        };
        self.has_controls = !blocks.iter().all(|block| matches!(block, Block::Draw(_)));
        let place = self.outlines.place_count();
        let entries = &entries;
        let nodes = Stored { entries, curves }.nodes(self, &blocks);
        self.list(nodes, place)
    }

    /// A list whose segments are those from `place` on.
    fn list(&self, nodes: Span, place: usize) -> List {
        List {
            nodes,
            places: self.outlines.places_from(place),
            has_outlines: self.has_outlines(nodes),
        }
    }

    /// How much making the quarters of a list looks at: each segment for two rows and four quarters, and
    /// each node.
    pub(super) fn work(list: &List) -> u64 {
        let (segments, nodes) = (list.places.range().len(), list.nodes.range().len());
        6 * segments as u64 + 4 * nodes as u64
    }

    /// How many commands a list has, and their hash.
    pub(super) fn summary(&self, list: &List, order: Order) -> (usize, u64) {
        // By the list itself, so that equal lists have equal hashes whatever their cells hold beside.
        let mut nodes = self.nodes[list.nodes.range()].iter();
        if !self.has_controls || nodes.all(|node| matches!(node, Node::Draw(_))) {
            return commands::summary(self, list.nodes);
        }
        let mut written = Vec::new();
        commands::write(self, list.nodes, order, &mut written);
        (written.len(), hash::of_all(&written))
    }

    /// Prepares [`Self::within`] for parts of these heights of the region that the list is for.
    pub(super) fn trace(&mut self, list: &List, y: [f64; 2]) {
        self.outlines.trace(list.places, y);
    }

    /// What of the list shows between two x, within the heights of [`Self::trace`].
    pub(super) fn within(&mut self, list: &List, x: [f64; 2]) -> List {
        let place = self.outlines.place_count();
        let first = self.pending.len();
        let nodes = if self.has_controls {
            self.cut(list.nodes, x);
            self.keep(first)
        } else {
            self.cut_parts(list.nodes, x)
        };
        self.list(nodes, place)
    }

    /// As [`Self::cut`], for a list without clips and groups. The nodes are complete.
    fn cut_parts(&mut self, nodes: Span, x: [f64; 2]) -> Span {
        let first = self.nodes.len();
        for at in nodes.range() {
            let Node::Draw(part) = self.nodes[at] else {
                continue;
            };
            if let Some(part) = part.within(&mut self.outlines, x) {
                self.nodes.push(Node::Draw(part));
                if part.hides() {
                    break;
                }
            }
        }
        Span::from(first, &self.nodes)
    }

    /// The pending nodes from `first` on as a body or list.
    pub(super) fn keep(&mut self, first: usize) -> Span {
        let node = self.nodes.len();
        self.nodes.extend(self.pending.drain(first..));
        Span::from(node, &self.nodes)
    }

    /// Makes pending what of `nodes` shows, as far as the first that hides all behind it.
    pub(super) fn cut(&mut self, nodes: Span, x: [f64; 2]) {
        let first = self.pending.len();
        for at in nodes.range() {
            match self.nodes[at] {
                Node::Draw(part) => {
                    let part = part.within(&mut self.outlines, x);
                    self.pending.extend(part.map(Node::Draw));
                }
                Node::Clip(clip) => clip.cut(self, x),
                Node::Group(group) => group.cut(self, x),
            }
            if let Some(Node::Draw(part)) = self.pending[first..].last()
                && part.hides()
            {
                break;
            }
        }
    }

    /// Whether a part of the region can have less to show.
    pub(super) fn has_outlines(&self, nodes: Span) -> bool {
        self.nodes[nodes.range()].iter().any(|node| match node {
            Node::Draw(part) => part.outline.is_some(),
            Node::Clip(clip) => clip.has_outlines(self),
            Node::Group(group) => group.bodies(self).any(|body| self.has_outlines(body)),
        })
    }

    /// Whether some blocks are composited as one.
    pub(super) fn has_groups(&self, nodes: Span) -> bool {
        self.has_controls && self.has_groups_in(nodes)
    }

    fn has_groups_in(&self, nodes: Span) -> bool {
        self.nodes[nodes.range()].iter().any(|node| match node {
            Node::Draw(_) => false,
            Node::Clip(clip) => self.has_groups_in(clip.body),
            Node::Group(_) => true,
        })
    }

    /// The paint that fills the region, if nothing else shows.
    pub(super) fn solid(&self, nodes: Span) -> Option<u32> {
        match &self.nodes[nodes.range()] {
            [Node::Draw(part)] if part.is_full() => Some(part.tag & cmd::INDEX_MASK),
            _ => None,
        }
    }
}

impl Part {
    fn of(entry: &Entry, outline: Option<Outline>) -> Self {
        let opaque = if entry.opaque { cmd::OPAQUE_BIT } else { 0 };
        let kind = match entry.kind {
            EntryKind::Msdf => cmd::MSDF,
            EntryKind::Curves => cmd::CURVES,
            EntryKind::Image => cmd::IMAGE,
            _ => cmd::FULL,
        };
        Self {
            tag: (entry.index & cmd::INDEX_MASK) | kind | cmd::END_BIT | opaque,
            data: entry.data,
            outline,
        }
    }

    pub(super) fn is_full(&self) -> bool {
        self.tag & cmd::KIND_MASK == cmd::FULL
    }

    /// Whether nothing behind it shows.
    fn hides(&self) -> bool {
        self.is_full() && self.tag & cmd::OPAQUE_BIT != 0
    }

    fn within(self, outlines: &mut Outlines, x: [f64; 2]) -> Option<Self> {
        let Some(outline) = self.outline else {
            return Some(self);
        };
        let outline = outlines.within(outline, x);
        if !outline.is_uniform() {
            return Some(Self {
                outline: Some(outline),
                ..self
            });
        }
        outline.base_fills().then_some(Self {
            tag: self.tag & !cmd::KIND_MASK | cmd::FULL,
            data: 0,
            outline: None,
        })
    }
}

/// What blocks name.
struct Stored<'a> {
    entries: &'a [Entry],
    curves: &'a [u32],
}

impl Stored<'_> {
    fn nodes(&self, arena: &mut Arena, blocks: &[Block]) -> Span {
        let first = arena.pending.len();
        for block in blocks {
            let node = self.node(arena, block);
            arena.pending.push(node);
        }
        arena.keep(first)
    }

    fn node(&self, arena: &mut Arena, block: &Block) -> Node {
        match block {
            Block::Draw(at) => {
                let entry = self.entries[*at];
                let has_record = entry.kind == EntryKind::Curves;
                let outline = has_record.then(|| self.outline(arena, *at)).flatten();
                Node::Draw(Part::of(&entry, outline))
            }
            Block::Clip { branches, body } => {
                let all = branches.clone().map(|at| {
                    let outline = self.outline(arena, at).unwrap_or_default();
                    Branch::new(self.entries, branches, at, outline)
                });
                let all: Vec<Branch> = all.collect();
                let body = self.nodes(arena, body);
                Node::Clip(Clip::new(arena, &all, body))
            }
            Block::Group {
                masks,
                open,
                body,
                close,
            } => {
                let masks = masks.iter().map(|mask| Mask {
                    kind: self.entries[mask.close].data,
                    body: self.nodes(arena, &mask.body),
                });
                let masks: Vec<Mask> = masks.collect();
                let first = arena.masks.len();
                arena.masks.extend(masks);
                Node::Group(Group {
                    masks: Span::from(first, &arena.masks),
                    isolated: self.entries[*open].data == OPEN_ISOLATED,
                    body: self.nodes(arena, body),
                    mode: self.entries[*close].index,
                    opacity: self.entries[*close].data,
                })
            }
        }
    }

    fn outline(&self, arena: &mut Arena, at: usize) -> Option<Outline> {
        let place = self.entries[at].data as usize;
        let words = self.curves.get(place..)?;
        arena.outlines.decode(words)
    }
}
