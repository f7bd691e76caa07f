//! Who belongs to whom: groups that clip, mask, fade or blend what they hold.
//!
//! Items are numbered depth first in painter's order; of a scope its clips' outlines come first,
//! then what its masks show, then its children. So a node's items are a range of numbers.

use vtex_format::{BlendMode, MaskKind};

/// A drawing's nodes, back to front.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tree {
    /// What lies directly on the canvas.
    pub(crate) roots: Vec<Node>,
}

/// An item or a group of them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    /// Index of an item that is painted.
    Item(u32),
    /// A group that is more than the sum of its items.
    Scope(Box<Scope>),
}

/// A group with what is done to it as a whole. Nothing of it shows outside the clips; then it is
/// faded by opacity and masks, then blended with what lies behind it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scope {
    /// Its first item and the one behind its last.
    pub(crate) items: [u32; 2],
    /// A point shows where it lies in all of them.
    pub(crate) clips: Vec<Clip>,
    /// Their weights multiply.
    pub(crate) masks: Vec<Mask>,
    /// In \[0, 1\].
    pub(crate) opacity: f32,
    /// How it is composited.
    pub(crate) blend: BlendMode,
    /// Whether what is inside blends with nothing outside.
    pub(crate) isolated: bool,
    /// Back to front.
    pub(crate) children: Vec<Node>,
}

/// A region: where any of its parts is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Clip {
    /// The union's members.
    pub(crate) parts: Vec<ClipPart>,
}

/// An outline, itself clipped.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClipPart {
    /// Index of the item that is the outline.
    pub(crate) item: u32,
    /// A point of the outline counts where it lies in all of them.
    pub(crate) clips: Vec<Clip>,
}

/// A picture whose light or alpha fades a group.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mask {
    /// What of the picture counts.
    pub(crate) kind: MaskKind,
    /// Its first item and the one behind its last.
    pub(crate) items: [u32; 2],
    /// Back to front, over nothing.
    pub(crate) children: Vec<Node>,
}

impl Tree {
    /// Items without groups.
    pub(crate) fn flat(items: usize) -> Self {
        let count = u32::try_from(items).unwrap_or(u32::MAX);
        Self {
            roots: (0..count).map(Node::Item).collect(),
        }
    }

    /// The tree after items went: `place[i]` is the new number of item `i`. Numbers keep their
    /// order.
    pub(crate) fn renumbered(self, place: &[Option<u32>]) -> Self {
        // New numbers before an old one, for ends of ranges.
        let mut before = vec![0; place.len() + 1];
        for (index, kept) in place.iter().enumerate() {
            before[index + 1] = before[index] + u32::from(kept.is_some());
        }
        let renumbering = Renumbering { place, before };
        Self {
            roots: renumbering.nodes(self.roots),
        }
    }
}

impl Node {
    /// Its first item and the one behind its last.
    pub(crate) fn items(&self) -> [u32; 2] {
        match self {
            Self::Item(item) => [*item, item + 1],
            Self::Scope(scope) => scope.items,
        }
    }
}

impl Scope {
    /// Whether lookups have to composite it apart from what lies behind.
    pub(crate) fn is_group(&self) -> bool {
        self.isolated || self.opacity < 1.0 || !self.masks.is_empty()
    }
}

struct Renumbering<'a> {
    place: &'a [Option<u32>],
    before: Vec<u32>,
}

impl Renumbering<'_> {
    fn range(&self, items: [u32; 2]) -> [u32; 2] {
        items.map(|item| self.before[item as usize])
    }

    fn nodes(&self, nodes: Vec<Node>) -> Vec<Node> {
        nodes
            .into_iter()
            .filter_map(|node| match node {
                Node::Item(item) => self.place[item as usize].map(Node::Item),
                Node::Scope(scope) => self.scope(*scope),
            })
            .collect()
    }

    /// `None` when nothing is left to show.
    fn scope(&self, scope: Scope) -> Option<Node> {
        let children = self.nodes(scope.children);
        if children.is_empty() {
            return None;
        }
        let mask = |mask: Mask| Mask {
            kind: mask.kind,
            items: self.range(mask.items),
            children: self.nodes(mask.children),
        };
        Some(Node::Scope(Box::new(Scope {
            items: self.range(scope.items),
            clips: self.clips(scope.clips),
            masks: scope.masks.into_iter().map(mask).collect(),
            children,
            ..scope
        })))
    }

    fn clips(&self, clips: Vec<Clip>) -> Vec<Clip> {
        let part = |part: ClipPart| {
            Some(ClipPart {
                item: self.place[part.item as usize]?,
                clips: self.clips(part.clips),
            })
        };
        let clips = clips.into_iter().map(|clip| Clip {
            parts: clip.parts.into_iter().filter_map(part).collect(),
        });
        clips.collect()
    }
}
