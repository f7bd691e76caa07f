//! The commands of all lists.

use std::collections::BTreeMap;

use super::commands::Order;
use super::list::List;
use crate::layout::cell;

/// What a cell shows.
#[derive(Clone, Debug)]
pub(super) enum Shown {
    /// Nothing, or one paint: the cell's word.
    Paint(u32),
    /// What a list says.
    List {
        /// Of the cell's word.
        tag: u32,
        commands: Vec<[u32; 4]>,
        /// Of the commands.
        hash: u64,
    },
}

impl Shown {
    pub(super) fn of(list: &List) -> Self {
        if list.is_empty() {
            return Self::Paint(cell::EMPTY);
        }
        if let Some(paint) = list.solid() {
            return Self::Paint(cell::SOLID << cell::TAG_SHIFT | paint);
        }
        let (tag, order) = if list.has_groups() {
            (cell::GROUPS, Order::BackToFront)
        } else {
            (cell::LIST, Order::FrontToBack)
        };
        let commands = list.commands(order);
        let hash = hash(commands.as_flattened());
        Self::List {
            tag,
            commands,
            hash,
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
    /// The word of a cell.
    pub(super) fn word(&mut self, shown: &Shown) -> u32 {
        match shown {
            Shown::Paint(word) => *word,
            Shown::List {
                tag,
                commands,
                hash,
            } => tag << cell::TAG_SHIFT | self.place(commands, *hash).min(cell::PAYLOAD_MASK),
        }
    }

    fn place(&mut self, commands: &[[u32; 4]], hash: u64) -> u32 {
        let next = u32::try_from(self.commands.len()).unwrap_or(cell::PAYLOAD_MASK);
        let known = *self.known.entry(hash).or_insert(next);
        let stored = self.commands.get(known as usize..);
        if known != next && stored.is_some_and(|stored| stored.starts_with(commands)) {
            return known;
        }
        self.commands.extend(commands);
        next
    }
}

/// A hash that need not stand up to an adversary: equal ones are compared, or are an estimate.
fn hash(words: &[u32]) -> u64 {
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |hash: u64, &word: &u32| {
        (hash ^ u64::from(word))
            .wrapping_mul(FACTOR)
            .rotate_left(29)
    };
    words.iter().fold(FACTOR, mix)
}
