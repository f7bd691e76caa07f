//! The clips of a group in one cell, as conditional branches.
//!
//! In most cells a clip is everywhere or nowhere, and costs nothing. Only outlines that cross the
//! cell become branches. They evaluate a formula of unions and intersections the way compilers
//! evaluate `&&` and `||`: each may decide the whole and be taken.

use super::entry::{CurvesDraft, draft_curves};
use crate::{
    cells::input::{CellInput, Present},
    drawing::tree::{Clip, ClipPart},
};

/// Where in the cell a group shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Formula<'a> {
    Never,
    Always,
    /// Inside the outline of a curve record.
    Inside(Box<CurvesDraft<'a>>),
    /// The intersection of two or more.
    All(Vec<Self>),
    /// The union of two or more.
    Any(Vec<Self>),
}

/// One branch: lookups on one side of an outline skip what follows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Branch<'a> {
    pub(super) outline: CurvesDraft<'a>,
    /// Whether it is taken inside, instead of outside.
    pub(super) taken_inside: bool,
    /// Index of the branch that they continue with. The number of branches stands for the group's
    /// body, `None` for the end of the group.
    pub(super) to: Option<usize>,
}

/// What `clips` come to in a cell that shows the items `present`.
pub(super) fn formula<'a>(
    input: &CellInput<'a>,
    clips: &[Clip],
    present: &[Present],
    cell: u32,
) -> Formula<'a> {
    all(clips.iter().map(|clip| {
        let parts = clip.parts.iter();
        any(parts.map(|part| of_part(input, part, present, cell)))
    }))
}

/// An outline and the clips on it. Absent from the cell it covers no point, full it covers all.
fn of_part<'a>(
    input: &CellInput<'a>,
    part: &ClipPart,
    present: &[Present],
    cell: u32,
) -> Formula<'a> {
    let Ok(place) = present.binary_search_by_key(&part.item, |present| present.item) else {
        return Formula::Never;
    };
    let outline = if present[place].full {
        Formula::Always
    } else {
        let strips = draft_curves(input, part.item, cell).into_iter();
        any(strips.map(|strip| Formula::Inside(Box::new(strip))))
    };
    let clips = formula(input, &part.clips, present, cell);
    all([clips, outline])
}

/// The intersection, simplified.
fn all<'a>(formulas: impl IntoIterator<Item = Formula<'a>>) -> Formula<'a> {
    let mut kept = Vec::new();
    for formula in formulas {
        match formula {
            // One empty member makes the intersection empty.
            Formula::Never => return Formula::Never,
            Formula::Always => {}
            // Nested intersections become one, which saves branches to branches.
            Formula::All(inner) => kept.extend(inner),
            other => kept.push(other),
        }
    }
    match kept.len() {
        0 => Formula::Always,
        1 => kept.swap_remove(0),
        _ => Formula::All(kept),
    }
}

/// The union, simplified.
fn any<'a>(formulas: impl IntoIterator<Item = Formula<'a>>) -> Formula<'a> {
    let mut kept = Vec::new();
    for formula in formulas {
        match formula {
            // One full member makes the union full.
            Formula::Always => return Formula::Always,
            Formula::Never => {}
            Formula::Any(inner) => kept.extend(inner),
            other => kept.push(other),
        }
    }
    match kept.len() {
        0 => Formula::Never,
        1 => kept.swap_remove(0),
        _ => Formula::Any(kept),
    }
}

impl<'a> Formula<'a> {
    /// The branches that precede a body which shows only where the formula holds.
    pub(super) fn into_branches(self) -> Vec<Branch<'a>> {
        let mut code = Code::default();
        code.branch_if(self, false, Label::End);
        code.finish()
    }
}

/// The target of a branch whose place may not be known yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Label {
    /// The end of the group.
    End,
    /// Index into [`Code::places`].
    Place(usize),
}

/// Short-circuit evaluation. Branches are in order and go forward only, so evaluation ends.
#[derive(Debug, Default)]
struct Code<'a> {
    branches: Vec<(CurvesDraft<'a>, bool, Label)>,
    places: Vec<usize>,
}

impl<'a> Code<'a> {
    /// Emits branches that are taken where `formula` is `value` and fall through elsewhere.
    fn branch_if(&mut self, formula: Formula<'a>, value: bool, to: Label) {
        match formula {
            Formula::Always | Formula::Never => {}
            Formula::Inside(outline) => self.branches.push((*outline, value, to)),
            // An intersection is false as soon as one member is.
            Formula::All(formulas) => self.chain(formulas, false, value, to),
            // A union is true as soon as one member is.
            Formula::Any(formulas) => self.chain(formulas, true, value, to),
        }
    }

    /// As [`Self::branch_if`], for formulas of which the first that is `decisive` decides the
    /// whole.
    fn chain(&mut self, mut formulas: Vec<Formula<'a>>, decisive: bool, value: bool, to: Label) {
        // Every member may decide on its own, so each branches to the target directly.
        if decisive == value {
            for formula in formulas {
                self.branch_if(formula, value, to);
            }
            return;
        }
        // Otherwise the target is reached only if no member decides. All but the last branch behind
        // the whole when they decide; the last one alone can branch to the target.
        let last = formulas.pop();
        let behind = Label::Place(self.places.len());
        self.places.push(0);
        let Label::Place(place) = behind else { return };
        for formula in formulas {
            self.branch_if(formula, decisive, behind);
        }
        if let Some(last) = last {
            self.branch_if(last, value, to);
        }
        // Here the evaluation continues when a member has decided.
        self.places[place] = self.branches.len();
    }

    fn finish(self) -> Vec<Branch<'a>> {
        let places = self.places;
        let branch = |(outline, taken_inside, to)| Branch {
            outline,
            taken_inside,
            to: match to {
                Label::End => None,
                Label::Place(place) => Some(places[place]),
            },
        };
        self.branches.into_iter().map(branch).collect()
    }
}
