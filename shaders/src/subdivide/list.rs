//! The list of a part of a cell.

use vtex_format::{Block, Entry, EntryKind, MAX_ENTRIES_PER_CELL, OPEN_ISOLATED, list_blocks};

use super::clip::{Branch, Clip};
use super::group::{Group, Mask};
use super::outline::{Outline, Outlines, Span};

/// An entry that draws, with its outline if it has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) entry: Entry,
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
}

impl Arena {
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
        }
    }

    /// Prepares [`Self::within`] for parts of these heights of the region that the list is for.
    pub(super) fn trace(&mut self, list: &List, y: [f64; 2]) {
        self.outlines.trace(list.places, y);
    }

    /// What of the list shows between two x, within the heights of [`Self::trace`].
    pub(super) fn within(&mut self, list: &List, x: [f64; 2]) -> List {
        let place = self.outlines.place_count();
        let first = self.pending.len();
        self.cut(list.nodes, x);
        let nodes = self.keep(first);
        self.list(nodes, place)
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
                && part.entry.kind == EntryKind::Full
                && part.entry.opaque
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
        self.nodes[nodes.range()].iter().any(|node| match node {
            Node::Draw(_) => false,
            Node::Clip(clip) => self.has_groups(clip.body),
            Node::Group(_) => true,
        })
    }

    /// The paint that fills the region, if nothing else shows.
    pub(super) fn solid(&self, nodes: Span) -> Option<u32> {
        match &self.nodes[nodes.range()] {
            [Node::Draw(part)] if part.entry.kind == EntryKind::Full => Some(part.entry.index),
            _ => None,
        }
    }
}

impl Part {
    fn within(self, outlines: &mut Outlines, x: [f64; 2]) -> Option<Self> {
        let Some(outline) = self.outline else {
            return Some(self);
        };
        let outline = outlines.within(outline, x);
        if !outline.is_uniform() {
            return Some(Self {
                entry: self.entry,
                outline: Some(outline),
            });
        }
        let full = Entry {
            kind: EntryKind::Full,
            data: 0,
            ..self.entry
        };
        outline.base_fills().then_some(Self {
            entry: full,
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
                Node::Draw(Part { entry, outline })
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
