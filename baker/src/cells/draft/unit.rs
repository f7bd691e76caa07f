//! One cell's list as a tree: entries and the groups that hold them.

use vtex_format::{BlendMode, MaskKind};

use super::{
    clip::{self, Formula, Test},
    entry::{Draft, draft_run},
};
use crate::{
    cells::{
        input::{CellInput, Present},
        lists::TileDraft,
        paint_table::PaintTable,
    },
    drawing::{
        color,
        tree::{Mask, Node, Scope},
    },
};

/// What a list holds, front to back.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unit<'a> {
    Entry(Draft<'a>),
    Scope(ScopeDraft<'a>),
}

/// A group in a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ScopeDraft<'a> {
    /// Where it shows, if not everywhere.
    pub(super) tests: Vec<Test<'a>>,
    pub(super) masks: Vec<(MaskKind, Vec<Unit<'a>>)>,
    /// Whether the body is composited by itself, and how.
    pub(super) group: Option<GroupDraft>,
    pub(super) body: Vec<Unit<'a>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GroupDraft {
    pub(super) isolated: bool,
    pub(super) opacity: f32,
    pub(super) blend: BlendMode,
}

/// The list of a cell with the items in it, in painter's order.
pub(super) fn draft_cell<'a>(
    input: &CellInput<'a>,
    present: &[Present],
    cell: u32,
    paints: &mut PaintTable,
) -> Vec<Unit<'a>> {
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

impl<'a> Unit<'a> {
    /// Entries that it takes.
    pub(super) fn entry_count(&self) -> usize {
        match self {
            Self::Entry(_) => 1,
            Self::Scope(scope) => Self::scope_entry_count(scope),
        }
    }

    /// Entries that a group takes.
    pub(super) fn scope_entry_count(scope: &ScopeDraft<'_>) -> usize {
        let count = |units: &[Unit<'_>]| units.iter().map(Unit::entry_count).sum::<usize>();
        let masks = scope.masks.iter().map(|(_, units)| count(units) + 2);
        let group = if scope.group.is_some() { 2 } else { 0 };
        scope.tests.len() + masks.sum::<usize>() + group + count(&scope.body)
    }

    /// Adds the tiles that it needs.
    pub(super) fn tiles(&self, tiles: &mut Vec<TileDraft>) {
        match self {
            Self::Entry(Draft::Tile { tile, .. }) => tiles.push(tile.clone()),
            Self::Entry(_) => {}
            Self::Scope(scope) => {
                let masks = scope.masks.iter().flat_map(|(_, units)| units);
                for unit in masks.chain(&scope.body) {
                    unit.tiles(tiles);
                }
            }
        }
    }

    /// Whether nothing behind it shows in the cell.
    fn hides(&self, paints: &PaintTable) -> bool {
        match self {
            Self::Entry(draft) => draft.hides(paints),
            Self::Scope(scope) => {
                let plain =
                    |group: &GroupDraft| group.opacity >= 1.0 && group.blend == BlendMode::Normal;
                scope.tests.is_empty()
                    && scope.masks.is_empty()
                    && scope.group.as_ref().is_none_or(plain)
                    && scope.body.last().is_some_and(|unit| unit.hides(paints))
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
    /// What `nodes` show, front to back, cut behind what hides the rest. `present` may hold items
    /// that are none of theirs.
    fn nodes(&mut self, nodes: &'a [Node], present: &[Present]) -> Vec<Unit<'a>> {
        let mut units = Vec::new();
        let mut run = Vec::new();
        let mut rest = present;
        while let Some((last, before)) = rest.split_last() {
            let behind = nodes.partition_point(|node| node.items()[0] <= last.item);
            let node = nodes[..behind].last();
            match node.filter(|node| last.item < node.items()[1]) {
                Some(Node::Item(_)) => {
                    run.push(*last);
                    rest = before;
                }
                Some(Node::Scope(scope)) => {
                    if self.end_run(&mut run, &mut units) {
                        return units;
                    }
                    let first = rest.partition_point(|other| other.item < scope.items[0]);
                    let (others, own) = rest.split_at(first);
                    rest = others;
                    units.extend(self.scope(scope, own));
                    if units.last().is_some_and(|unit| unit.hides(self.paints)) {
                        return units;
                    }
                }
                None => rest = before,
            }
        }
        self.end_run(&mut run, &mut units);
        units
    }

    /// Adds the entries of items that no group comes between; whether they hide the rest.
    fn end_run(&mut self, run: &mut Vec<Present>, units: &mut Vec<Unit<'a>>) -> bool {
        let items = std::mem::take(run);
        let drafts = draft_run(self.input, items, self.cell, self.paints);
        units.extend(drafts.into_iter().map(Unit::Entry));
        units.last().is_some_and(|unit| unit.hides(self.paints))
    }

    /// What is left of a group in the cell.
    fn scope(&mut self, scope: &'a Scope, present: &[Present]) -> Vec<Unit<'a>> {
        let formula = clip::formula(self.input, &scope.clips, present, self.cell);
        if formula == Formula::Never {
            return Vec::new();
        }
        let body = self.nodes(&scope.children, present);
        if body.is_empty() {
            return Vec::new();
        }
        let mut opacity = scope.opacity;
        let mut masks = Vec::new();
        for mask in &scope.masks {
            match self.mask(mask, present) {
                Ok(weight) => opacity *= weight,
                Err(units) => masks.push((mask.kind, units)),
            }
        }
        if opacity <= 0.0 {
            return Vec::new();
        }
        let tests = formula.into_tests();
        let is_group = scope.isolated || opacity < 1.0 || !masks.is_empty();
        let mut body = body;
        let mut group = is_group.then_some(GroupDraft {
            isolated: scope.isolated,
            opacity,
            blend: scope.blend,
        });
        if masks.is_empty() && scope.blend == BlendMode::Normal && self.fades(&mut body, opacity) {
            group = None;
        }
        if tests.is_empty() && group.is_none() {
            return body;
        }
        vec![Unit::Scope(ScopeDraft {
            tests,
            masks,
            group,
            body,
        })]
    }

    /// The one weight that a mask has in the whole cell, or what it shows.
    fn mask(&mut self, mask: &'a Mask, present: &[Present]) -> Result<f32, Vec<Unit<'a>>> {
        let units = self.nodes(&mask.children, present);
        match units.as_slice() {
            [] => Ok(0.0),
            [Unit::Entry(Draft::Full { paint })] => match self.paints.color(*paint) {
                Some(color) => Ok(color::mask_weight(mask.kind, color)),
                None => Err(units),
            },
            _ => Err(units),
        }
    }

    /// Fades what a group shows instead of the group, where the result is the same: of a single
    /// entry with a solid paint.
    fn fades(&mut self, body: &mut [Unit<'a>], opacity: f32) -> bool {
        let [Unit::Entry(draft)] = body else {
            // Of entries that hide each other, none can be faded alone.
            return opacity >= 1.0 && body.iter().all(|unit| matches!(unit, Unit::Entry(_)));
        };
        let paint = match draft {
            Draft::Full { paint } | Draft::Tile { paint, .. } => paint,
            Draft::Curves(curves) => &mut curves.paint,
            Draft::Image { .. } => return opacity >= 1.0,
        };
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
