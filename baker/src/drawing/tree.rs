//! The tree of groups: each clips, masks, fades or blends what it holds.
//!
//! Items are numbered depth first, in painter's order. Within a group the outlines of its clips
//! come first, then the items of its masks, then its children. So the items of any node are one
//! range of numbers, and a search for the node of an item is a binary search.

use vtex_format::{BlendMode, MaskKind};

/// A drawing's nodes, back to front.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tree {
    /// The nodes that are in no group.
    pub(crate) roots: Vec<Node>,
}

/// An item or a group of them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Node {
    /// Index of an item that paints.
    Item(u32),
    /// A group that shows something other than its items painted one by one.
    Group(Box<Group>),
}

/// Items that are clipped, masked, faded or blended as a whole, in this order: the clips cut it,
/// the masks and the opacity fade it, and the blend mode composites it with what lies behind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Group {
    /// Its first item and one past its last.
    pub(crate) items: [u32; 2],
    /// The group shows at points that lie in all of them.
    pub(crate) clips: Vec<Clip>,
    /// Their weights multiply.
    pub(crate) masks: Vec<Mask>,
    /// In \[0, 1\].
    pub(crate) opacity: f32,
    /// Its blend mode.
    pub(crate) blend: BlendMode,
    /// Whether blend modes inside see nothing of what lies behind the group.
    pub(crate) isolated: bool,
    /// Back to front.
    pub(crate) children: Vec<Node>,
}

/// A region: the union of its parts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Clip {
    /// Outlines, each perhaps clipped itself.
    pub(crate) parts: Vec<ClipPart>,
}

/// An outline, itself clipped.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClipPart {
    /// Index of the item that holds the outline.
    pub(crate) item: u32,
    /// Only points that lie in all of them count.
    pub(crate) clips: Vec<Clip>,
}

/// A picture whose luminance or alpha weights a group.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mask {
    /// Luminance or alpha.
    pub(crate) kind: MaskKind,
    /// Its first item and one past its last.
    pub(crate) items: [u32; 2],
    /// Back to front, painted over transparent black.
    pub(crate) children: Vec<Node>,
}

impl Tree {
    /// A tree of `items` items without groups.
    pub(crate) fn ungrouped(items: usize) -> Self {
        let count = u32::try_from(items).unwrap_or(u32::MAX);
        Self {
            roots: (0..count).map(Node::Item).collect(),
        }
    }

    /// The tree after some items were removed: `place[i]` is the new number of item `i`, `None` if
    /// it is gone. Numbers must keep their order.
    pub(crate) fn renumbered(self, place: &[Option<u32>]) -> Self {
        // How many items are kept before each old number: the ends of ranges become these.
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
    /// Its first item and one past its last.
    pub(crate) fn items(&self) -> [u32; 2] {
        match self {
            Self::Item(item) => [*item, item + 1],
            Self::Group(group) => group.items,
        }
    }
}

impl Group {
    /// Whether lookups must composite it apart from what lies behind. Clips alone do not need that.
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
                Node::Group(group) => self.group(*group),
            })
            .collect()
    }

    /// `None` when nothing is left to show.
    fn group(&self, group: Group) -> Option<Node> {
        let children = self.nodes(group.children);
        if children.is_empty() {
            return None;
        }
        let mask = |mask: Mask| Mask {
            kind: mask.kind,
            items: self.range(mask.items),
            children: self.nodes(mask.children),
        };
        Some(Node::Group(Box::new(Group {
            items: self.range(group.items),
            clips: self.clips(group.clips),
            masks: group.masks.into_iter().map(mask).collect(),
            children,
            ..group
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
