//! The commands of all lists.

use std::collections::BTreeMap;

use super::commands::{self, Order};
use super::list::{Arena, List};
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
        /// How the commands lie.
        order: Order,
        /// How many commands there are.
        count: usize,
        /// Of the commands.
        hash: u64,
    },
}

impl Shown {
    pub(super) fn of(arena: &Arena, list: &List) -> Self {
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
        let (count, hash) = arena.summary(list, order);
        Self::List {
            tag,
            order,
            count,
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
    /// The word of a cell with this list, which is shown.
    pub(super) fn word(&mut self, arena: &Arena, list: &List, shown: Shown) -> u32 {
        match shown {
            Shown::Paint(word) => word,
            Shown::List {
                tag, order, hash, ..
            } => {
                let place = self.place(arena, list, order, hash);
                tag << cell::TAG_SHIFT | place.min(cell::PAYLOAD_MASK)
            }
        }
    }

    fn place(&mut self, arena: &Arena, list: &List, order: Order, hash: u64) -> u32 {
        let first = self.commands.len();
        let next = u32::try_from(first).unwrap_or(cell::PAYLOAD_MASK);
        commands::write(arena, list.nodes, order, &mut self.commands);
        let known = *self.known.entry(hash).or_insert(next);
        let (stored, written) = self.commands.split_at(first);
        let stored = stored.get(known as usize..).unwrap_or(&[]);
        let stored = stored.as_flattened();
        if known != next && stored.starts_with(written.as_flattened()) {
            self.commands.truncate(first);
            return known;
        }
        next
    }
}
