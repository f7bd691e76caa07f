//! The commands of all lists.

use std::collections::BTreeMap;

use super::commands::{self, Order};
use super::list::{Arena, List};
use super::outline::Span;
use crate::layout::cell;

/// What a cell shows.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shown {
    /// Nothing, or one paint: the cell's word.
    Paint(u32),
    /// What a list says.
    List {
        /// Of the cell's word.
        tag: u32,
        /// Of the commands of the cell of the file.
        commands: Span,
        /// Of the commands.
        hash: u64,
    },
}

impl Shown {
    /// `written` takes the commands.
    pub(super) fn of(arena: &Arena, list: &List, written: &mut Vec<[u32; 4]>) -> Self {
        if list.nodes.is_empty() {
            return Self::Paint(cell::EMPTY);
        }
        if let Some(paint) = arena.solid(list.nodes) {
            return Self::Paint(cell::SOLID << cell::TAG_SHIFT | paint);
        }
        let (tag, order) = if arena.has_groups(list.nodes) {
            (cell::GROUPS, Order::BackToFront)
        } else {
            (cell::LIST, Order::FrontToBack)
        };
        let first = written.len();
        commands::write(arena, list.nodes, order, written);
        Self::List {
            tag,
            commands: Span::from(first, written),
            hash: hash(&written[first..]),
        }
    }
}

/// The commands of lists, those of equal lists once.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) commands: Vec<[u32; 4]>,
    /// First commands of lists by the hash of all. Of two with one hash the first is shared.
    known: BTreeMap<u64, u32>,
}

impl Lists {
    /// The word of a cell, whose commands are among those that were `written`.
    pub(super) fn word(&mut self, shown: Shown, written: &[[u32; 4]]) -> u32 {
        match shown {
            Shown::Paint(word) => word,
            Shown::List {
                tag,
                commands,
                hash,
            } => {
                let place = self.place(&written[commands.range()], hash);
                tag << cell::TAG_SHIFT | place.min(cell::PAYLOAD_MASK)
            }
        }
    }

    fn place(&mut self, commands: &[[u32; 4]], hash: u64) -> u32 {
        let next = u32::try_from(self.commands.len()).unwrap_or(cell::PAYLOAD_MASK);
        let known = *self.known.entry(hash).or_insert(next);
        let stored = self.commands.get(known as usize..).unwrap_or(&[]);
        let stored = stored.as_flattened();
        if known != next && stored.starts_with(commands.as_flattened()) {
            return known;
        }
        self.commands.extend(commands);
        next
    }
}

/// A hash that need not stand up to an adversary: equal ones are compared, or are an estimate.
fn hash(commands: &[[u32; 4]]) -> u64 {
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |hash: u64, word: u64| (hash ^ word).wrapping_mul(FACTOR).rotate_left(29);
    let pair = |low: u32, high: u32| u64::from(high) << 32 | u64::from(low);
    commands.iter().fold(FACTOR, |hash, &[a, c, b, tag]| {
        mix(mix(hash, pair(a, c)), pair(b, tag))
    })
}
