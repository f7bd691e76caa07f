//! The table of a pool: which texture has which handle.

use std::collections::VecDeque;

use vtex_shaders::set::{MAX_GENERATION, TextureHandle, table};

/// Entries of the smallest table: 512 bytes.
const FEWEST_ENTRIES: u32 = 64;

/// What the entries of the table hold.
#[derive(Clone, Debug)]
pub(super) struct Handles<T> {
    pool: u32,
    entries: Vec<Entry<T>>,
    /// Entries without a texture that can still have one, the one that is free for longest first.
    free: VecDeque<u32>,
}

#[derive(Clone, Debug)]
struct Entry<T> {
    /// How many textures had the entry.
    generation: u32,
    texture: Option<T>,
}

impl<T> Handles<T> {
    pub(super) fn of_pool(pool: u32) -> Self {
        Self {
            pool,
            entries: Vec::new(),
            free: VecDeque::new(),
        }
    }

    pub(super) fn pool(&self) -> u32 {
        self.pool
    }

    /// Gives the texture a handle; none where the table is full.
    pub(super) fn insert(&mut self, texture: T) -> Option<TextureHandle> {
        let slot = match self.free.pop_front() {
            Some(slot) => slot,
            None => self.push()?,
        };
        let entry = &mut self.entries[slot as usize];
        entry.generation += 1;
        entry.texture = Some(texture);
        Some(TextureHandle::new(self.pool, slot, entry.generation))
    }

    fn push(&mut self) -> Option<u32> {
        let slot = u32::try_from(self.entries.len()).ok()?;
        (slot <= table::SLOT_MASK).then(|| {
            self.entries.push(Entry {
                generation: 0,
                texture: None,
            });
            slot
        })
    }

    /// How many more textures it can have.
    pub(super) fn room(&self) -> usize {
        table::SLOT_MASK as usize + 1 - self.entries.len() + self.free.len()
    }

    pub(super) fn remove(&mut self, handle: TextureHandle) -> Option<T> {
        self.get(handle)?;
        let entry = &mut self.entries[handle.slot() as usize];
        // An entry whose count is at its end is never used again: no two textures have one handle.
        if entry.generation < MAX_GENERATION {
            self.free.push_back(handle.slot());
        }
        entry.texture.take()
    }

    pub(super) fn get(&self, handle: TextureHandle) -> Option<&T> {
        let entry = self.entries.get(handle.slot() as usize)?;
        let is_current = TextureHandle::new(self.pool, handle.slot(), entry.generation) == handle;
        entry.texture.as_ref().filter(|_| is_current)
    }

    /// All textures, with their handles.
    pub(super) fn iter(&self) -> impl Iterator<Item = (TextureHandle, &T)> {
        (0..).zip(&self.entries).filter_map(|(slot, entry)| {
            let handle = TextureHandle::new(self.pool, slot, entry.generation);
            Some((handle, entry.texture.as_ref()?))
        })
    }

    pub(super) fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.entries.iter_mut().filter_map(|e| e.texture.as_mut())
    }

    pub(super) fn len(&self) -> usize {
        self.iter().count()
    }

    /// How many entries the table on the device is to have with so many more textures: a power of two.
    pub(super) fn capacity_with(&self, more: usize) -> u32 {
        let entries = self.entries.len() + more.saturating_sub(self.free.len());
        let entries = u32::try_from(entries).unwrap_or(u32::MAX);
        entries.max(FEWEST_ENTRIES).next_power_of_two()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_is_given_once() {
        let mut handles = Handles::of_pool(3);
        let mut given = std::collections::BTreeSet::new();
        for round in 0..3 * MAX_GENERATION {
            let handle = handles.insert(round).unwrap();
            assert_eq!(handle.pool(), 3);
            assert!(given.insert(handle), "{handle:?}");
            assert_eq!(handles.get(handle), Some(&round));
            assert_eq!(handles.remove(handle), Some(round));
            assert_eq!(handles.remove(handle), None);
        }
        assert_eq!(handles.entries.len(), 3, "an entry is used until its end");
        assert!(handles.get(TextureHandle::NONE).is_none());
        let handle = handles.insert(0).unwrap();
        let elsewhere = TextureHandle::from_bits(handle.to_bits() ^ 1 << table::POOL_SHIFT);
        assert!(handles.get(elsewhere).is_none(), "of another pool");
    }

    #[test]
    fn a_table_ends() {
        let mut handles = Handles::of_pool(0);
        let most = table::SLOT_MASK as usize + 1;
        assert_eq!(handles.room(), most);
        for _ in 0..most {
            handles.insert(()).unwrap();
        }
        assert_eq!((handles.room(), handles.insert(())), (0, None));
        assert_eq!(handles.capacity_with(0), table::SLOT_MASK + 1);
        let (first, ()) = handles.iter().next().unwrap();
        handles.remove(first).unwrap();
        assert_eq!(handles.room(), 1);
        assert_eq!(handles.capacity_with(1), table::SLOT_MASK + 1);
    }
}
