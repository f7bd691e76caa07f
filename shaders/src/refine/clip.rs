//! A clip of a list in a part of a cell: tests that are decided there go.

use std::ops::Range;

use vtex_format::{Entry, jump_target};

use super::list::{Node, any_outline, command_count, within};
use super::outline::{Outline, Region};

/// Blocks behind tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Clip {
    pub(super) tests: Vec<Test>,
    pub(super) body: Vec<Node>,
}

/// A test that passes over what lies between it and `to`, or does not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Test {
    /// Without one it always passes over.
    pub(super) outline: Option<Outline>,
    /// Whether it passes over inside the outline instead of outside.
    pub(super) inside: bool,
    pub(super) to: Goal,
}

/// Where a lookup goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// A test of the same clip, by its place.
    Test(usize),
    /// What the clip guards.
    Body,
    /// Behind the clip.
    End,
}

impl Clip {
    /// The clip of `tests`, places in `entries`, with their outlines.
    pub(super) fn new(
        entries: &[Entry],
        tests: Range<usize>,
        outline: impl Fn(usize) -> Outline,
        body: Vec<Node>,
    ) -> Self {
        let test = |at: usize| Test {
            outline: Some(outline(at)),
            inside: entries[at].opaque,
            to: match jump_target(at, &entries[at]) {
                target if target < tests.end => Goal::Test(target - tests.start),
                target if target == tests.end => Goal::Body,
                _ => Goal::End,
            },
        };
        Self {
            tests: tests.clone().map(test).collect(),
            body,
        }
    }

    pub(super) fn has_outlines(&self) -> bool {
        self.tests.iter().any(|test| test.outline.is_some()) || any_outline(&self.body)
    }

    pub(super) fn command_count(&self) -> usize {
        let of = |test: &Test| test.outline.as_ref().map_or(1, Outline::command_count);
        self.tests.iter().map(of).sum::<usize>() + command_count(&self.body)
    }

    /// What shows in a region: nothing, this clip with fewer tests, or its body without any.
    pub(super) fn within(&self, region: &Region) -> Vec<Node> {
        let tests: Vec<Test> = self.tests.iter().map(|test| test.within(region)).collect();
        let goals = goals(&tests);
        match goals.first() {
            Some(Goal::End) => Vec::new(),
            Some(Goal::Test(_)) => {
                let body = within(&self.body, region);
                if body.is_empty() {
                    return body;
                }
                let tests = kept(&tests, &goals);
                vec![Node::Clip(Self { tests, body })]
            }
            Some(Goal::Body) | None => within(&self.body, region),
        }
    }
}

impl Test {
    /// Without outline where it is decided: then `to` says for which.
    fn within(&self, region: &Region) -> Self {
        let outline = self.outline.as_ref().map(|outline| outline.within(region));
        let decided = outline.as_ref().filter(|outline| outline.is_uniform());
        let falls = decided.is_some_and(|outline| outline.base_fills() != self.inside);
        Self {
            outline: outline.filter(|outline| !outline.is_uniform()),
            inside: self.inside,
            to: if falls { FALLS } else { self.to },
        }
    }
}

/// Goal of a decided test that never passes over anything: its own place or one before is none.
const FALLS: Goal = Goal::Test(0);

/// For each test where a lookup that comes to it goes: to a test that is not decided, or beyond.
fn goals(tests: &[Test]) -> Vec<Goal> {
    let mut goals = vec![Goal::Body; tests.len() + 1];
    for (place, test) in tests.iter().enumerate().rev() {
        let falls = goals[place + 1];
        let jumps = jump(test, &goals, falls);
        goals[place] = if test.outline.is_none() || jumps == falls {
            jumps
        } else {
            Goal::Test(place)
        };
    }
    goals
}

/// Where the jump of a test leads.
fn jump(test: &Test, goals: &[Goal], falls: Goal) -> Goal {
    match test.to {
        FALLS => falls,
        Goal::Test(to) => goals[to],
        goal => goal,
    }
}

/// The tests that lookups come to, with jumps to each other.
fn kept(tests: &[Test], goals: &[Goal]) -> Vec<Test> {
    let mut reached = vec![false; tests.len()];
    let mark = |goal: Goal, reached: &mut Vec<bool>| {
        if let Goal::Test(place) = goal {
            reached[place] = true;
        }
    };
    mark(goals[0], &mut reached);
    for (place, test) in tests.iter().enumerate() {
        if reached[place] {
            mark(goals[place + 1], &mut reached);
            mark(jump(test, goals, goals[place + 1]), &mut reached);
        }
    }
    let mut kept: Vec<Test> = Vec::new();
    let mut places = vec![0; tests.len()];
    for (place, test) in tests
        .iter()
        .enumerate()
        .filter(|(place, _)| reached[*place])
    {
        let next = (place + 1..tests.len()).find(|&next| reached[next]);
        let next = next.map_or(Goal::Body, Goal::Test);
        let falls = goals[place + 1];
        let jumps = jump(test, goals, falls);
        places[place] = kept.len();
        // What is next needs no jump, whichever side leads there.
        let turned = falls != next && jumps == next;
        kept.push(Test {
            outline: test.outline.clone(),
            inside: test.inside != turned,
            to: if turned { falls } else { jumps },
        });
        if falls != next && !turned {
            kept.push(Test {
                outline: None,
                inside: true,
                to: falls,
            });
        }
    }
    for test in &mut kept {
        if let Goal::Test(place) = test.to {
            test.to = Goal::Test(places[place]);
        }
    }
    kept
}
