//! Where the words of a pool's textures lie in its buffer.

use std::ops::Range;

/// Words are given out in groups of four.
pub(super) const GROUP_BYTES: u64 = 16;
/// Groups that the smallest buffer has for textures: 16 KiB.
const FEWEST_GROUPS: u32 = 1024;

/// Ranges of groups, counted from the first behind the table.
#[derive(Clone, Debug, Default)]
pub(super) struct Words {
    capacity: u32,
    /// In order, and no two of them touch.
    free: Vec<Range<u32>>,
}

impl Words {
    fn new(capacity: u32) -> Self {
        let free = std::iter::once(0..capacity).collect();
        Self { capacity, free }
    }

    pub(super) fn capacity(&self) -> u32 {
        self.capacity
    }

    pub(super) fn free_groups(&self) -> u32 {
        self.free.iter().map(|range| range.end - range.start).sum()
    }

    /// The start of the smallest free range that is as long, the first of equals.
    pub(super) fn allocate(&mut self, groups: u32) -> Option<Range<u32>> {
        let long = |range: &Range<u32>| range.end - range.start;
        let fits = self
            .free
            .iter()
            .enumerate()
            .filter(|(_, range)| long(range) >= groups);
        let (index, _) = fits.min_by_key(|(_, range)| long(range))?;
        let range = &mut self.free[index];
        let taken = range.start..range.start + groups;
        range.start = taken.end;
        if range.start == range.end {
            self.free.remove(index);
        }
        Some(taken)
    }

    pub(super) fn free(&mut self, range: Range<u32>) {
        let index = self.free.partition_point(|free| free.start < range.start);
        self.free.insert(index, range);
        self.join(index);
        if index > 0 {
            self.join(index - 1);
        }
    }

    /// Makes one of a range and the next where they touch.
    fn join(&mut self, index: usize) {
        if let [range, next, ..] = &mut self.free[index..]
            && range.end == next.start
        {
            range.end = next.end;
            self.free.remove(index + 1);
        }
    }

    /// Ranges of these lengths, closely one after the other, in a buffer for them and for growth: twice
    /// as large as before, unless what `most` leaves is less or a quarter stays free anyway. They need no
    /// more than `most`.
    pub(super) fn rebuilt(
        &self,
        lengths: impl Iterator<Item = u32> + Clone,
        most: u32,
    ) -> (Self, Vec<Range<u32>>) {
        let needed = lengths.clone().fold(0, u32::saturating_add);
        let now = self.capacity();
        let has_room = u64::from(now) * 3 >= 4 * u64::from(needed);
        let grown = if has_room { now } else { now.saturating_mul(2) };
        let mut words = Self::new(grown.max(FEWEST_GROUPS).min(most).max(needed));
        let mut end = 0;
        let placed = lengths.map(|length| {
            let start = end;
            end += length;
            start..end
        });
        let placed = placed.collect();
        words.free.retain_mut(|free| {
            free.start = needed;
            free.start < free.end
        });
        (words, placed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_freed_is_given_out_again_and_joined() {
        let mut words = Words::new(100);
        let ranges: Vec<_> = (0..10).map(|_| words.allocate(10).unwrap()).collect();
        assert_eq!(words.allocate(1), None);
        for index in [3, 5, 4, 9, 8, 0] {
            words.free(ranges[index].clone());
        }
        assert_eq!(words.free, [0..10, 30..60, 80..100]);
        assert_eq!(words.free_groups(), 60);
        assert_eq!(
            words.allocate(10),
            Some(0..10),
            "the smallest that is enough"
        );
        assert_eq!(words.allocate(15), Some(80..95));
        assert_eq!(words.allocate(31), None);
        assert_eq!(words.allocate(30), Some(30..60));
    }

    #[test]
    fn a_buffer_doubles_and_is_packed_closely() {
        let (words, placed) = Words::default().rebuilt([700, 800].into_iter(), 10_000);
        assert_eq!(placed, [0..700, 700..1500]);
        assert_eq!(words.capacity(), 1500, "at first as large as needed");
        assert_eq!(words.free_groups(), 0);
        let (mut words, placed) = words.rebuilt([800, 900].into_iter(), 10_000);
        assert_eq!(placed, [0..800, 800..1700]);
        assert_eq!(words.capacity(), 3000);
        assert_eq!(words.allocate(1300), Some(1700..3000));
        // Holes alone are no reason to grow.
        let (words, _) = words.rebuilt([2000].into_iter(), 10_000);
        assert_eq!(words.capacity(), 3000);
        let (words, _) = words.rebuilt([3001].into_iter(), 4000);
        assert_eq!(words.capacity(), 4000, "no more than there may be");
        let (words, _) = words.rebuilt([1500, 2500].into_iter(), 4000);
        assert_eq!((words.capacity(), words.free_groups()), (4000, 0));
    }
}
