//! The trees, and random ones.

use vtex_format::{BlendMode, MaskKind};

use crate::random::Random;

/// Something that shows.
#[derive(Clone, Debug)]
pub enum Node {
    /// A filled outline, or all of the cell.
    Shape {
        /// Index of a record.
        outline: Option<usize>,
        /// Index of a paint.
        paint: usize,
    },
    /// What is clipped, or composited as one.
    Group(Group),
}

/// An element or group with a clip, masks, opacity or a blend mode.
#[derive(Clone, Debug)]
pub struct Group {
    /// Outside it nothing shows.
    pub clip: Option<Clip>,
    /// Composited as one; without it the nodes show one by one.
    pub compositing: Option<Compositing>,
    /// What shows, back to front.
    pub body: Vec<Node>,
}

/// How a group is composited.
#[derive(Clone, Debug)]
pub struct Compositing {
    /// Whether it starts from nothing.
    pub isolated: bool,
    /// Normal unless it is isolated.
    pub mode: BlendMode,
    /// In \[0, 1\].
    pub opacity: f32,
    /// All of them weigh it.
    pub masks: Vec<Mask>,
}

/// A mask's content.
#[derive(Clone, Debug)]
pub struct Mask {
    /// What of the content is the weight.
    pub kind: MaskKind,
    /// What shows in it, back to front.
    pub body: Vec<Node>,
}

/// Where any part is, and what else is asked for.
#[derive(Clone, Debug)]
pub struct Clip {
    /// At least one.
    pub parts: Vec<Part>,
    /// A clip of the clip path itself.
    pub also: Option<Box<Self>>,
}

/// A child of a clip path.
#[derive(Clone, Debug)]
pub struct Part {
    /// Index of a record.
    pub outline: usize,
    /// The child's own clip.
    pub clip: Option<Box<Clip>>,
}

/// What random trees are made of.
#[derive(Clone, Copy, Debug)]
pub struct Wants {
    /// Clips.
    pub clips: bool,
    /// Groups and masks.
    pub groups: bool,
    /// Blend modes.
    pub blends: bool,
}

/// Records and paints of a random drawing.
pub(super) const COUNT: u32 = 8;

fn index(r: &mut Random) -> usize {
    r.below(COUNT) as usize
}

/// A few nodes, at most `depth` in one another.
pub(super) fn random_nodes(r: &mut Random, wants: Wants, depth: u32) -> Vec<Node> {
    let count = 1 + r.below(3);
    (0..count).map(|_| random_node(r, wants, depth)).collect()
}

fn random_node(r: &mut Random, wants: Wants, depth: u32) -> Node {
    if depth == 0 || r.below(5) < 2 {
        return Node::Shape {
            outline: (r.below(8) > 0).then(|| index(r)),
            paint: index(r),
        };
    }
    let clips = wants.clips && (!wants.groups || r.below(2) == 0);
    let groups = wants.groups && r.below(3) > 0;
    Node::Group(Group {
        clip: clips.then(|| random_clip(r, 2)),
        compositing: groups.then(|| random_compositing(r, wants, depth - 1)),
        body: random_nodes(r, wants, depth - 1),
    })
}

fn random_clip(r: &mut Random, depth: u32) -> Clip {
    let inner = |r: &mut Random| {
        let has = depth > 0 && r.below(4) == 0;
        has.then(|| Box::new(random_clip(r, depth - 1)))
    };
    let count = 1 + r.below(3);
    let part = |r: &mut Random| Part {
        outline: index(r),
        clip: inner(r),
    };
    Clip {
        parts: (0..count).map(|_| part(r)).collect(),
        also: inner(r),
    }
}

fn random_compositing(r: &mut Random, wants: Wants, depth: u32) -> Compositing {
    let isolated = r.below(2) == 0;
    let blends = wants.blends && isolated;
    let masks = if depth > 0 && r.below(3) == 0 {
        1 + r.below(2)
    } else {
        0
    };
    let mask = |r: &mut Random| Mask {
        kind: MaskKind::ALL[r.below(3) as usize],
        body: random_nodes(r, wants, depth.min(2) - 1),
    };
    Compositing {
        isolated,
        mode: BlendMode::ALL[if blends { r.below(16) as usize } else { 0 }],
        opacity: if r.below(3) == 0 { 1.0 } else { r.unit() },
        masks: (0..masks).map(|_| mask(r)).collect(),
    }
}
