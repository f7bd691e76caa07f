//! A clip of a list in a part of a cell: branches that are decided there go.

use std::ops::Range;

use vtex_format::{Entry, branch_target};

use super::list::{Node, any_outline, command_count, within};
use super::outline::{Outline, Region};

/// Blocks behind branches.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Clip {
    pub(super) branches: Vec<Branch>,
    pub(super) body: Vec<Node>,
}

/// A branch to `to`, taken or not.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// The clip of `branches`, places in `entries`, with their outlines.
    pub(super) fn new(
        entries: &[Entry],
        branches: Range<usize>,
        outline: impl Fn(usize) -> Outline,
        body: Vec<Node>,
    ) -> Self {
        let branch = |at: usize| Branch {
            outline: Some(outline(at)),
            inside: entries[at].opaque,
            to: match branch_target(at, &entries[at]) {
                target if target < branches.end => Goal::Branch(target - branches.start),
                target if target == branches.end => Goal::Body,
                _ => Goal::End,
            },
        };
        Self {
            branches: branches.clone().map(branch).collect(),
            body,
        }
    }

    pub(super) fn has_outlines(&self) -> bool {
        self.branches.iter().any(|branch| branch.outline.is_some()) || any_outline(&self.body)
    }

    pub(super) fn command_count(&self) -> usize {
        let of = |branch: &Branch| branch.outline.as_ref().map_or(1, Outline::command_count);
        self.branches.iter().map(of).sum::<usize>() + command_count(&self.body)
    }

    /// What shows in a region: nothing, this clip with fewer branches, or its body without any.
    pub(super) fn within(&self, region: &Region) -> Vec<Node> {
        let branches: Vec<Branch> = self
            .branches
            .iter()
            .map(|branch| branch.within(region))
            .collect();
        let goals = goals(&branches);
        match goals.first() {
            Some(Goal::End) => Vec::new(),
            Some(Goal::Branch(_)) => {
                let body = within(&self.body, region);
                if body.is_empty() {
                    return body;
                }
                let branches = kept(&branches, &goals);
                vec![Node::Clip(Self { branches, body })]
            }
            Some(Goal::Body) | None => within(&self.body, region),
        }
    }
}

impl Branch {
    /// Without outline where it is decided: then `to` says for which.
    fn within(&self, region: &Region) -> Self {
        let outline = self.outline.as_ref().map(|outline| outline.within(region));
        let decided = outline.as_ref().filter(|outline| outline.is_uniform());
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
            outline: branch.outline.clone(),
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
