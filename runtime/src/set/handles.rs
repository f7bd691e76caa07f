//! The table of a set: which texture has which handle.

use std::collections::VecDeque;

use vtex_shaders::set::{MAX_GENERATION, TextureHandle, table};

use crate::RuntimeError;

/// Entries of the smallest table: 512 bytes.
const FEWEST_ENTRIES: u32 = 64;

/// What the entries of the table hold.
#[derive(Clone, Debug)]
pub(super) struct Handles<T> {
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

impl<T> Default for Handles<T> {
    fn default() -> Self {
        Self {
            entries: Vec::new(),
            free: VecDeque::new(),
        }
    }
}

impl<T> Handles<T> {
    pub(super) fn insert(&mut self, texture: T) -> Result<TextureHandle, RuntimeError> {
        let slot = match self.free.pop_front() {
            Some(slot) => slot,
            None => self.push()?,
        };
        let entry = &mut self.entries[slot as usize];
        entry.generation += 1;
        entry.texture = Some(texture);
        Ok(TextureHandle::new(slot, entry.generation))
    }

    fn push(&mut self) -> Result<u32, RuntimeError> {
        let slot = u32::try_from(self.entries.len());
        let slot = slot.ok().filter(|&slot| slot < table::SLOT_MASK);
        let slot = slot.ok_or_else(|| {
            RuntimeError::Limit(format!(
                "a set has handles for {} textures: remove some, or make a second set",
                table::SLOT_MASK
            ))
        })?;
        self.entries.push(Entry {
            generation: 0,
            texture: None,
        });
        Ok(slot)
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
        let is_current = TextureHandle::new(handle.slot(), entry.generation) == handle;
        entry.texture.as_ref().filter(|_| is_current)
    }

    /// All textures, with their handles.
    pub(super) fn iter(&self) -> impl Iterator<Item = (TextureHandle, &T)> {
        (0..).zip(&self.entries).filter_map(|(slot, entry)| {
            let handle = TextureHandle::new(slot, entry.generation);
            Some((handle, entry.texture.as_ref()?))
        })
    }

    pub(super) fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.entries.iter_mut().filter_map(|e| e.texture.as_mut())
    }

    pub(super) fn len(&self) -> usize {
        self.iter().count()
    }

    /// How many entries the table on the device is to have: a power of two.
    pub(super) fn capacity(&self) -> u32 {
        let entries = u32::try_from(self.entries.len()).unwrap_or(u32::MAX);
        entries.max(FEWEST_ENTRIES).next_power_of_two()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_is_given_once() {
        let mut handles = Handles::default();
        let mut given = std::collections::BTreeSet::new();
        for round in 0..3 * MAX_GENERATION {
            let handle = handles.insert(round).unwrap();
            assert!(given.insert(handle), "{handle:?}");
            assert_eq!(handles.get(handle), Some(&round));
            assert_eq!(handles.remove(handle), Some(round));
            assert_eq!(handles.remove(handle), None);
        }
        assert_eq!(handles.entries.len(), 3, "an entry is used until its end");
        assert!(handles.get(TextureHandle::NONE).is_none());
    }

    #[test]
    fn handles_end_with_an_error() {
        let mut handles = Handles::default();
        for _ in 0..table::SLOT_MASK {
            handles.insert(()).unwrap();
        }
        assert!(matches!(
            handles.insert(()),
            Err(RuntimeError::Limit(message)) if message.contains("second set")
        ));
        assert_eq!(handles.capacity(), table::SLOT_MASK + 1);
    }
}
