//! The list of a part of a cell.

use vtex_format::{Block, Entry, EntryKind, MAX_ENTRIES_PER_CELL, OPEN_ISOLATED, list_blocks};

use super::clip::Clip;
use super::commands::{Order, commands};
use super::group::{Group, Mask};
use super::outline::{Outline, Region};

/// An entry that draws, with its outline if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) entry: Entry,
    pub(super) outline: Option<Outline>,
}

/// A block of a list, as [`Block`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Node {
    Draw(Part),
    Clip(Clip),
    Group(Group),
}

/// What shows in a region, front to back.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct List {
    nodes: Vec<Node>,
}

impl List {
    /// The list of a whole cell; `words` starts at its first entry.
    pub(super) fn decode(words: &[u32], curves: &[u32]) -> Self {
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
        let stored = Stored { entries, curves };
        let entries = &stored.entries;
        let draws = |at: &usize| entries[*at].kind.draws();
        let ungrouped = || (0..entries.len()).filter(draws).map(Block::Draw).collect();
        // What no validator lets in shows without what clips and groups it.
        let blocks = if (0..entries.len()).all(|at| draws(&at)) {
            ungrouped()
        } else {
            list_blocks(entries).unwrap_or_else(|_| ungrouped())
        };
        Self {
            nodes: stored.nodes(&blocks),
        }
    }

    /// Whether a part of the region can have less to show.
    pub(super) fn has_outlines(&self) -> bool {
        any_outline(&self.nodes)
    }

    /// Commands a lookup walks at most.
    pub(super) fn command_count(&self) -> usize {
        command_count(&self.nodes)
    }

    /// What shows in `region`, a part of the region this is for.
    pub(super) fn within(&self, region: &Region) -> Self {
        Self {
            nodes: within(&self.nodes, region),
        }
    }

    /// Whether some blocks are composited as one.
    pub(super) fn has_groups(&self) -> bool {
        any_group(&self.nodes)
    }

    /// The paint that fills the region, if nothing else shows.
    pub(super) fn solid(&self) -> Option<u32> {
        match self.nodes.as_slice() {
            [Node::Draw(part)] if part.entry.kind == EntryKind::Full => Some(part.entry.index),
            _ => None,
        }
    }

    /// Whether nothing shows.
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The commands, four words each.
    pub(super) fn commands(&self, order: Order) -> Vec<[u32; 4]> {
        commands(&self.nodes, order)
    }
}

fn any_group(nodes: &[Node]) -> bool {
    nodes.iter().any(|node| match node {
        Node::Draw(_) => false,
        Node::Clip(clip) => any_group(&clip.body),
        Node::Group(_) => true,
    })
}

pub(super) fn any_outline(nodes: &[Node]) -> bool {
    nodes.iter().any(|node| match node {
        Node::Draw(part) => part.outline.is_some(),
        Node::Clip(clip) => clip.has_outlines(),
        Node::Group(group) => group.bodies().any(|body| any_outline(body)),
    })
}

pub(super) fn command_count(nodes: &[Node]) -> usize {
    let of = |node: &Node| match node {
        Node::Draw(part) => part.outline.as_ref().map_or(1, Outline::command_count),
        Node::Clip(clip) => clip.command_count(),
        // Each body lies between two commands.
        Node::Group(group) => group.bodies().map(|body| 2 + command_count(body)).sum(),
    };
    nodes.iter().map(of).sum()
}

/// What of `nodes` shows in a region, as far as the first that hides all behind it.
pub(super) fn within(nodes: &[Node], region: &Region) -> Vec<Node> {
    let mut inner = Vec::new();
    for node in nodes {
        match node {
            Node::Draw(part) => inner.extend(part.within(region).map(Node::Draw)),
            Node::Clip(clip) => inner.extend(clip.within(region)),
            Node::Group(group) => inner.extend(group.within(region)),
        }
        if let Some(Node::Draw(part)) = inner.last()
            && part.entry.kind == EntryKind::Full
            && part.entry.opaque
        {
            break;
        }
    }
    inner
}

impl Part {
    fn within(&self, region: &Region) -> Option<Self> {
        let Some(outline) = &self.outline else {
            return Some(self.clone());
        };
        let outline = outline.within(region);
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
    entries: Vec<Entry>,
    curves: &'a [u32],
}

impl Stored<'_> {
    fn nodes(&self, blocks: &[Block]) -> Vec<Node> {
        blocks.iter().map(|block| self.node(block)).collect()
    }

    fn node(&self, block: &Block) -> Node {
        match block {
            Block::Draw(at) => {
                let entry = self.entries[*at];
                let has_record = entry.kind == EntryKind::Curves;
                let outline = has_record.then(|| self.outline(*at)).flatten();
                Node::Draw(Part { entry, outline })
            }
            Block::Clip { branches, body } => {
                let outline = |at| self.outline(at).unwrap_or_default();
                let branches = branches.clone();
                Node::Clip(Clip::new(
                    &self.entries,
                    branches,
                    outline,
                    self.nodes(body),
                ))
            }
            Block::Group {
                masks,
                open,
                body,
                close,
            } => {
                let mask = |mask: &vtex_format::MaskBlock| Mask {
                    kind: self.entries[mask.close].data,
                    body: self.nodes(&mask.body),
                };
                Node::Group(Group {
                    masks: masks.iter().map(mask).collect(),
                    isolated: self.entries[*open].data == OPEN_ISOLATED,
                    body: self.nodes(body),
                    mode: self.entries[*close].index,
                    opacity: self.entries[*close].data,
                })
            }
        }
    }

    fn outline(&self, at: usize) -> Option<Outline> {
        let place = self.entries[at].data as usize;
        self.curves.get(place..).and_then(Outline::decode)
    }
}
