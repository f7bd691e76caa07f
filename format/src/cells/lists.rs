//! Lists of entries: where they end and what they hold.

use super::cell::{Entry, LAST_BIT, MAX_ENTRIES_PER_CELL};

/// For each entry the number of entries from it to the next last one, both counted; `None` when
/// there are more than [`MAX_ENTRIES_PER_CELL`] or none is the last. One backward pass, however lists
/// overlap.
pub(crate) fn list_lengths(entries: &[u32]) -> Vec<Option<u32>> {
    let (pairs, _) = entries.as_chunks::<2>();
    let mut length = None;
    // From the back each count follows from the one behind it. A count that is too large becomes
    // `None` and stays so up to the next last entry.
    let backward = pairs.iter().rev().map(|[head, _]| {
        length = if head & LAST_BIT != 0 {
            Some(1)
        } else {
            length
                .map(|behind| behind + 1)
                .filter(|&all| all <= MAX_ENTRIES_PER_CELL)
        };
        length
    });
    let mut lengths: Vec<_> = backward.collect();
    lengths.reverse();
    lengths
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
        assert_eq!(list_lengths(&entries), expected);
    }

    #[test]
    fn a_list_one_too_long_does_not_end() {
        let most = MAX_ENTRIES_PER_CELL as usize;
        let mut entries = vec![0; 2 * (most + 1)];
        entries[2 * most] = LAST_BIT;
        let lengths = list_lengths(&entries);
        assert_eq!(lengths[0], None);
        assert_eq!(lengths[1], Some(MAX_ENTRIES_PER_CELL));
    }
}
