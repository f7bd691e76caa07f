//! One cell's list as a tree of blocks: entries, clips with their body, and groups.
//!
//! The tree of the drawing is walked front to back with the items of the cell. Groups that have no
//! effect in the cell disappear, and everything behind the first opaque full entry is left out.

use vtex_format::{BlendMode, MaskKind};

use super::{
    clip::{self, Branch, Formula},
    entry::{Draft, draft_ungrouped},
};
use crate::{
    cells::{
        input::{CellInput, Present},
        lists::TileDraft,
        paint_table::PaintTable,
    },
    drawing::{
        color,
        tree::{Group, Mask, Node},
    },
};

/// One element of a list.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Block<'a> {
    /// An entry that draws.
    Entry(Draft<'a>),
    /// A clip with its body, a group, or both.
    Group(GroupDraft<'a>),
}

/// What is left of a group in a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GroupDraft<'a> {
    /// The branches of its clips.
    pub(super) branches: Vec<Branch<'a>>,
    /// Masks whose weight differs within the cell.
    pub(super) masks: Vec<(MaskKind, Vec<Block<'a>>)>,
    /// How the body is composited as a whole; `None` when its entries may go straight into the
    /// list.
    pub(super) compositing: Option<Compositing>,
    /// Front to back.
    pub(super) body: Vec<Block<'a>>,
}

/// How a group is composited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Compositing {
    pub(super) isolated: bool,
    pub(super) opacity: f32,
    pub(super) blend: BlendMode,
}

/// The list of a cell that shows the items `present`, which are in painter's order.
pub(super) fn draft_cell<'a>(
    input: &CellInput<'a>,
    present: &[Present],
    cell: u32,
    paints: &mut PaintTable,
) -> Vec<Block<'a>> {
    if present.is_empty() {
        return Vec::new();
    }
    let mut drafting = Drafting {
        input,
        cell,
        paints,
    };
    drafting.nodes(&input.tree.roots, present)
}

impl<'a> Block<'a> {
    /// How many entries it takes.
    pub(super) fn entry_count(&self) -> usize {
        match self {
            Self::Entry(_) => 1,
            Self::Group(group) => Self::group_entry_count(group),
        }
    }

    /// How many entries a group takes.
    pub(super) fn group_entry_count(group: &GroupDraft<'_>) -> usize {
        let count = |blocks: &[Block<'_>]| blocks.iter().map(Block::entry_count).sum::<usize>();
        // Open before a mask's picture, and the entry that takes its weight after it.
        let masks = group.masks.iter().map(|(_, blocks)| count(blocks) + 2);
        let open_and_close = if group.compositing.is_some() { 2 } else { 0 };
        group.branches.len() + masks.sum::<usize>() + open_and_close + count(&group.body)
    }

    /// Adds the tiles that it names.
    pub(super) fn tiles(&self, tiles: &mut Vec<TileDraft>) {
        match self {
            Self::Entry(Draft::Tile { tile, .. }) => tiles.push(tile.clone()),
            Self::Entry(_) => {}
            Self::Group(group) => {
                let masks = group.masks.iter().flat_map(|(_, blocks)| blocks);
                for block in masks.chain(&group.body) {
                    block.tiles(tiles);
                }
            }
        }
    }

    /// Whether nothing behind it shows in the cell.
    fn hides(&self, paints: &PaintTable) -> bool {
        match self {
            Self::Entry(draft) => draft.hides(paints),
            Self::Group(group) => {
                let plain =
                    |how: &Compositing| how.opacity >= 1.0 && how.blend == BlendMode::Normal;
                group.branches.is_empty()
                    && group.masks.is_empty()
                    && group.compositing.as_ref().is_none_or(plain)
                    && group.body.last().is_some_and(|block| block.hides(paints))
            }
        }
    }
}

struct Drafting<'a, 'i, 'p> {
    input: &'i CellInput<'a>,
    cell: u32,
    paints: &'p mut PaintTable,
}

impl<'a> Drafting<'a, '_, '_> {
    /// What `nodes` show, front to back, cut behind the first block that hides the rest. `present`
    /// may hold other nodes' items too; those are skipped.
    fn nodes(&mut self, nodes: &'a [Node], present: &[Present]) -> Vec<Block<'a>> {
        let mut blocks = Vec::new();
        let mut ungrouped = Vec::new();
        let mut rest = present;
        while let Some((last, before)) = rest.split_last() {
            // The last node that begins at or before the item is the only one that can hold it.
            let behind = nodes.partition_point(|node| node.items()[0] <= last.item);
            let node = nodes[..behind].last();
            match node.filter(|node| last.item < node.items()[1]) {
                Some(Node::Item(_)) => {
                    ungrouped.push(*last);
                    rest = before;
                }
                Some(Node::Group(group)) => {
                    if self.end_ungrouped(&mut ungrouped, &mut blocks) {
                        return blocks;
                    }
                    // The group owns a range of items, which is a suffix of what is left.
                    let first = rest.partition_point(|other| other.item < group.items[0]);
                    let (others, own) = rest.split_at(first);
                    rest = others;
                    blocks.extend(self.group(group, own));
                    if blocks.last().is_some_and(|block| block.hides(self.paints)) {
                        return blocks;
                    }
                }
                None => rest = before,
            }
        }
        self.end_ungrouped(&mut ungrouped, &mut blocks);
        blocks
    }

    /// Adds the entries of `ungrouped`, items that no group comes between. Returns whether they
    /// hide the rest.
    fn end_ungrouped(&mut self, ungrouped: &mut Vec<Present>, blocks: &mut Vec<Block<'a>>) -> bool {
        let items = std::mem::take(ungrouped);
        let drafts = draft_ungrouped(self.input, items, self.cell, self.paints);
        blocks.extend(drafts.into_iter().map(Block::Entry));
        blocks.last().is_some_and(|block| block.hides(self.paints))
    }

    /// What is left of a group in the cell: nothing, its body, or one block.
    fn group(&mut self, group: &'a Group, present: &[Present]) -> Vec<Block<'a>> {
        let formula = clip::formula(self.input, &group.clips, present, self.cell);
        // Clipped away in this cell.
        if formula == Formula::Never {
            return Vec::new();
        }
        let body = self.nodes(&group.children, present);
        if body.is_empty() {
            return Vec::new();
        }
        // A mask that has one weight in the cell is an opacity.
        let mut opacity = group.opacity;
        let mut masks = Vec::new();
        for mask in &group.masks {
            match self.mask(mask, present) {
                Ok(weight) => opacity *= weight,
                Err(blocks) => masks.push((mask.kind, blocks)),
            }
        }
        // Faded to nothing in this cell.
        if opacity <= 0.0 {
            return Vec::new();
        }
        let branches = formula.into_branches();
        // The same rule as for the drawing, but with what is left in this cell.
        let is_group = group.isolated || opacity < 1.0 || !masks.is_empty();
        let mut body = body;
        let mut compositing = is_group.then_some(Compositing {
            isolated: group.isolated,
            opacity,
            blend: group.blend,
        });
        if masks.is_empty() && group.blend == BlendMode::Normal && self.fades(&mut body, opacity) {
            compositing = None;
        }
        if branches.is_empty() && compositing.is_none() {
            return body;
        }
        vec![Block::Group(GroupDraft {
            branches,
            masks,
            compositing,
            body,
        })]
    }

    /// The weight of a mask that is the same in the whole cell, or else the mask's picture as
    /// `Err`.
    fn mask(&mut self, mask: &'a Mask, present: &[Present]) -> Result<f32, Vec<Block<'a>>> {
        let blocks = self.nodes(&mask.children, present);
        match blocks.as_slice() {
            [] => Ok(0.0),
            [Block::Entry(Draft::Full { paint })] => match self.paints.color(*paint) {
                Some(color) => Ok(color::mask_weight(mask.kind, color)),
                None => Err(blocks),
            },
            _ => Err(blocks),
        }
    }

    /// Applies `opacity` to the body itself, so that no group is needed, and returns whether it
    /// could. A single entry with a solid paint can take it into the paint.
    fn fades(&mut self, body: &mut [Block<'a>], opacity: f32) -> bool {
        let [Block::Entry(draft)] = body else {
            // Several entries may hide each other: faded one by one they would show through.
            return opacity >= 1.0 && body.iter().all(|block| matches!(block, Block::Entry(_)));
        };
        let paint = match draft {
            Draft::Full { paint } | Draft::Tile { paint, .. } => paint,
            Draft::Curves(curves) => &mut curves.paint,
            Draft::Image { .. } => return opacity >= 1.0,
        };
        // A single entry has nothing to blend with inside the group.
        if opacity >= 1.0 {
            return true;
        }
        let Some(faded) = self.paints.intern_faded(*paint, opacity) else {
            return false;
        };
        *paint = faded;
        true
    }
}
