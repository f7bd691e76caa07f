//! Where clips let a group show in one cell, as a run of tests with jumps.

use super::entry::{CurvesDraft, draft_curves};
use crate::{
    cells::input::{CellInput, Present},
    drawing::tree::{Clip, ClipPart},
};

/// Where in the cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Formula<'a> {
    Never,
    Always,
    /// Inside the outline of a record.
    Inside(Box<CurvesDraft<'a>>),
    /// Where all are; two at least.
    All(Vec<Self>),
    /// Where one is; two at least.
    Any(Vec<Self>),
}

/// One step: lookups on one side of an outline pass over what follows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Test<'a> {
    pub(super) outline: CurvesDraft<'a>,
    /// Whether those inside jump, or those outside.
    pub(super) jumps_inside: bool,
    /// The test that they come to next; the number of tests stands for what the clip holds,
    /// `None` for the end of it.
    pub(super) to: Option<usize>,
}

/// What `clips` come to in a cell with these items.
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

fn all<'a>(formulas: impl IntoIterator<Item = Formula<'a>>) -> Formula<'a> {
    let mut kept = Vec::new();
    for formula in formulas {
        match formula {
            Formula::Never => return Formula::Never,
            Formula::Always => {}
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

fn any<'a>(formulas: impl IntoIterator<Item = Formula<'a>>) -> Formula<'a> {
    let mut kept = Vec::new();
    for formula in formulas {
        match formula {
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
    /// Tests ahead of what shows only where the formula holds.
    pub(super) fn into_tests(self) -> Vec<Test<'a>> {
        let mut code = Code::default();
        code.jump_if(self, false, Label::End);
        code.finish()
    }
}

/// Where a jump goes before places are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Label {
    End,
    /// Index into [`Code::places`].
    Place(usize),
}

/// Short-circuit evaluation: tests in order, jumps forward.
#[derive(Debug, Default)]
struct Code<'a> {
    tests: Vec<(CurvesDraft<'a>, bool, Label)>,
    places: Vec<usize>,
}

impl<'a> Code<'a> {
    /// Jumps where `formula` comes to `value`, falls through elsewhere.
    fn jump_if(&mut self, formula: Formula<'a>, value: bool, to: Label) {
        match formula {
            Formula::Always | Formula::Never => {}
            Formula::Inside(outline) => self.tests.push((*outline, value, to)),
            // The first that is false decides.
            Formula::All(formulas) => self.chain(formulas, false, value, to),
            // The first that is true decides.
            Formula::Any(formulas) => self.chain(formulas, true, value, to),
        }
    }

    /// Formulas of which the first that comes to `decisive` decides for that value.
    fn chain(&mut self, mut formulas: Vec<Formula<'a>>, decisive: bool, value: bool, to: Label) {
        if decisive == value {
            for formula in formulas {
                self.jump_if(formula, value, to);
            }
            return;
        }
        let last = formulas.pop();
        let behind = Label::Place(self.places.len());
        self.places.push(0);
        let Label::Place(place) = behind else { return };
        for formula in formulas {
            self.jump_if(formula, decisive, behind);
        }
        if let Some(last) = last {
            self.jump_if(last, value, to);
        }
        self.places[place] = self.tests.len();
    }

    fn finish(self) -> Vec<Test<'a>> {
        let places = self.places;
        let test = |(outline, jumps_inside, to)| Test {
            outline,
            jumps_inside,
            to: match to {
                Label::End => None,
                Label::Place(place) => Some(places[place]),
            },
        };
        self.tests.into_iter().map(test).collect()
    }
}
