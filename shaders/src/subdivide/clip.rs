//! A clip of a list in a part of a cell: branches that are decided there go.

use std::ops::Range;

use vtex_format::{Entry, branch_target};

use super::list::{Arena, Node};
use super::outline::{Outline, Outlines, Span};

/// Blocks behind branches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Clip {
    branches: Span,
    pub(super) body: Span,
}

/// A branch to `to`, taken or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Branch {
    /// Without one it is always taken.
    pub(super) outline: Option<Outline>,
    /// Whether it is taken inside the outline instead of outside.
    pub(super) inside: bool,
    pub(super) to: Goal,
}

/// Where a lookup goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// A branch of the same clip, by its place.
    Branch(usize),
    /// What the clip guards.
    Body,
    /// Behind the clip.
    End,
}

impl Clip {
    pub(super) fn new(arena: &mut Arena, branches: &[Branch], body: Span) -> Self {
        let first = arena.branches.len();
        arena.branches.extend(branches);
        Self {
            branches: Span::from(first, &arena.branches),
            body,
        }
    }

    pub(super) fn branches(self, arena: &Arena) -> &[Branch] {
        &arena.branches[self.branches.range()]
    }

    pub(super) fn has_outlines(self, arena: &Arena) -> bool {
        let mut branches = self.branches(arena).iter();
        branches.any(|branch| branch.outline.is_some()) || arena.has_outlines(self.body)
    }

    /// Makes pending what shows: nothing, this clip with fewer branches, or its body without any.
    pub(super) fn cut(self, arena: &mut Arena, x: [f64; 2]) {
        let branches = arena.branches[self.branches.range()].iter();
        let branches: Vec<Branch> = branches
            .map(|branch| branch.within(&mut arena.outlines, x))
            .collect();
        let goals = goals(&branches);
        let first = arena.pending.len();
        if goals[0] != Goal::End {
            arena.cut(self.body, x);
        }
        if matches!(goals[0], Goal::Branch(_)) && arena.pending.len() > first {
            let body = arena.keep(first);
            let clip = Self::new(arena, &kept(&branches, &goals), body);
            arena.pending.push(Node::Clip(clip));
        }
    }
}

impl Branch {
    /// The branch at `at` of `entries`, one of a clip's.
    pub(super) fn new(
        entries: &[Entry],
        branches: &Range<usize>,
        at: usize,
        outline: Outline,
    ) -> Self {
        Self {
            outline: Some(outline),
            inside: entries[at].opaque,
            to: match branch_target(at, &entries[at]) {
                target if target < branches.end => Goal::Branch(target - branches.start),
                target if target == branches.end => Goal::Body,
                _ => Goal::End,
            },
        }
    }

    /// Without outline where it is decided: then `to` says for which.
    fn within(&self, outlines: &mut Outlines, x: [f64; 2]) -> Self {
        let outline = self.outline.map(|outline| outlines.within(outline, x));
        let decided = outline.filter(Outline::is_uniform);
        let fallthrough = decided.is_some_and(|outline| outline.base_fills() != self.inside);
        Self {
            outline: outline.filter(|outline| !outline.is_uniform()),
            inside: self.inside,
            to: if fallthrough { NEVER } else { self.to },
        }
    }
}

/// Goal of a decided branch that is never taken: its own place or one before is none.
const NEVER: Goal = Goal::Branch(0);

/// For each branch where a lookup that comes to it goes: to a branch that is not decided, or
/// beyond.
fn goals(branches: &[Branch]) -> Vec<Goal> {
    let mut goals = vec![Goal::Body; branches.len() + 1];
    for (place, branch) in branches.iter().enumerate().rev() {
        let fallthrough = goals[place + 1];
        let taken = taken(branch, &goals, fallthrough);
        goals[place] = if branch.outline.is_none() || taken == fallthrough {
            taken
        } else {
            Goal::Branch(place)
        };
    }
    goals
}

/// Where a branch leads that is taken.
fn taken(branch: &Branch, goals: &[Goal], fallthrough: Goal) -> Goal {
    match branch.to {
        NEVER => fallthrough,
        Goal::Branch(to) => goals[to],
        goal => goal,
    }
}

/// The branches that lookups come to, with branches to each other.
fn kept(branches: &[Branch], goals: &[Goal]) -> Vec<Branch> {
    let mut reached = vec![false; branches.len()];
    let mark = |goal: Goal, reached: &mut Vec<bool>| {
        if let Goal::Branch(place) = goal {
            reached[place] = true;
        }
    };
    mark(goals[0], &mut reached);
    for (place, branch) in branches.iter().enumerate() {
        if reached[place] {
            mark(goals[place + 1], &mut reached);
            mark(taken(branch, goals, goals[place + 1]), &mut reached);
        }
    }
    let mut kept: Vec<Branch> = Vec::new();
    let mut places = vec![0; branches.len()];
    for (place, branch) in branches
        .iter()
        .enumerate()
        .filter(|(place, _)| reached[*place])
    {
        let next = (place + 1..branches.len()).find(|&next| reached[next]);
        let next = next.map_or(Goal::Body, Goal::Branch);
        let fallthrough = goals[place + 1];
        let taken = taken(branch, goals, fallthrough);
        places[place] = kept.len();
        // What is next needs no branch, whichever side leads there.
        let turned = fallthrough != next && taken == next;
        kept.push(Branch {
            outline: branch.outline,
            inside: branch.inside != turned,
            to: if turned { fallthrough } else { taken },
        });
        if fallthrough != next && !turned {
            kept.push(Branch {
                outline: None,
                inside: true,
                to: fallthrough,
            });
        }
    }
    for branch in &mut kept {
        if let Goal::Branch(place) = branch.to {
            branch.to = Goal::Branch(places[place]);
        }
    }
    kept
}
