//! Lists of entries: where they end and what they hold.

use super::cell::{Entry, LAST_BIT, MAX_ENTRIES_PER_CELL};

/// How many entries there are from each to the next last one.
#[derive(Debug)]
pub(crate) struct ListLengths {
    /// Both counted; 0 for none. Small, because a file may hold tens of millions of entries.
    lengths: Vec<u16>,
}

impl ListLengths {
    /// One backward pass, however lists overlap.
    pub(crate) fn of(entries: &[u32]) -> Self {
        let (pairs, _) = entries.as_chunks::<2>();
        let mut lengths = vec![0; pairs.len()];
        let mut length = 0;
        // From the back each count follows from the one behind it. A count that is too large becomes
        // 0 and stays so up to the next last entry.
        for ([head, _], stored) in pairs.iter().zip(&mut lengths).rev() {
            length = match length {
                _ if head & LAST_BIT != 0 => 1,
                0 => 0,
                behind if u32::from(behind) < MAX_ENTRIES_PER_CELL => behind + 1,
                _ => 0,
            };
            *stored = length;
        }
        Self { lengths }
    }

    /// `None` where no entry is there; `Some(None)` where more than [`MAX_ENTRIES_PER_CELL`] follow, or
    /// none is the last.
    pub(crate) fn at(&self, entry: usize) -> Option<Option<u32>> {
        let length = self.lengths.get(entry)?;
        Some((*length > 0).then(|| u32::from(*length)))
    }
}

/// The list whose first entry is at `place`; `None` when one of its words has no meaning, or it
/// does not end.
pub(crate) fn list_entries(entries: &[u32], place: usize) -> Option<Vec<Entry>> {
    let (pairs, _) = entries.as_chunks();
    let mut list = Vec::new();
    for &words in pairs
        .get(place..)?
        .iter()
        .take(MAX_ENTRIES_PER_CELL as usize)
    {
        let entry = Entry::decode(words)?;
        list.push(entry);
        if entry.last {
            return Some(list);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_count_to_the_next_last_entry() {
        let entries = [0, 0, LAST_BIT, 0, 0, 0, 0, 0, LAST_BIT, 0, 0, 0];
        let expected = [Some(2), Some(1), Some(3), Some(2), Some(1), None];
        let lengths = ListLengths::of(&entries);
        assert_eq!(
            [0, 1, 2, 3, 4, 5].map(|at| lengths.at(at)),
            expected.map(Some)
        );
        assert_eq!(lengths.at(6), None);
    }

    #[test]
    fn a_list_one_too_long_does_not_end() {
        let most = MAX_ENTRIES_PER_CELL as usize;
        let mut entries = vec![0; 2 * (most + 1)];
        entries[2 * most] = LAST_BIT;
        let lengths = ListLengths::of(&entries);
        assert_eq!(lengths.at(0), Some(None));
        assert_eq!(lengths.at(1), Some(Some(MAX_ENTRIES_PER_CELL)));
    }
}
