//! What of a set is where: handles, words, pages. A change is planned on a copy, so that one that fails,
//! or whose future is dropped, leaves the set as it was.

use std::ops::Range;

use vtex_shaders::Packed;
use vtex_shaders::set::{TextureHandle, table};

use super::handles::Handles;
use super::pages::{PageLimits, Pages, Room};
use super::words::{GROUP_BYTES, Overflow, Words};
use crate::RuntimeError;

/// What bounds a set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Bytes of the largest storage buffer that can be bound.
    pub(super) buffer_bytes: u64,
    pub(super) pages: PageLimits,
}

/// What of a set is where.
#[derive(Clone, Debug, Default)]
pub(super) struct Space {
    pub(super) handles: Handles<Member>,
    pub(super) words: Words,
    pub(super) pages: Pages,
    /// Groups in front of the textures': the table, and the texture that shows nothing.
    head: u32,
    /// Entries in the table.
    pub(super) entries: u32,
}

/// What a texture of the set has.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// Groups of words, counted from the head.
    pub(super) groups: Range<u32>,
    pub(super) rooms: Vec<Room>,
}

/// Words that are kept and lie elsewhere than before, in groups of the whole buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Move {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) groups: u32,
}

/// The space with more textures in it.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) space: Space,
    /// Of the textures added, in order.
    pub(super) added: Vec<TextureHandle>,
    /// Of the textures that are kept where a new buffer is needed.
    pub(super) moves: Option<Vec<Move>>,
}

impl Space {
    /// First group of a texture in the buffer.
    pub(super) fn first_group(&self, member: &Member) -> u32 {
        self.head + member.groups.start
    }

    /// Bytes of the whole buffer.
    pub(super) fn buffer_bytes(&self) -> u64 {
        GROUP_BYTES * (u64::from(self.head) + u64::from(self.words.capacity()))
    }

    /// First word of the texture that shows nothing.
    pub(super) fn nothing_word(&self) -> u32 {
        entries_end(self.entries)
    }

    pub(super) fn remove(&mut self, handle: TextureHandle) -> bool {
        let Some(member) = self.handles.remove(handle) else {
            return false;
        };
        self.words.free(member.groups);
        for room in member.rooms {
            self.pages.free(room);
        }
        true
    }

    /// With textures added, whose texels get their places. `nothing_words` is the length of the texture
    /// that shows nothing.
    pub(super) fn with(
        &self,
        textures: &mut [Packed],
        nothing_words: usize,
        bounds: &Bounds,
    ) -> Result<Plan, RuntimeError> {
        let mut space = self.clone();
        let mut rooms = space.rooms(textures, &bounds.pages)?.into_iter();
        let mut added = Vec::with_capacity(textures.len());
        let mut is_full = false;
        for texture in &mut *textures {
            let own: Vec<Room> = rooms.by_ref().take(page_count(texture)).collect();
            let places: Vec<_> = own.iter().map(|room| room.place).collect();
            texture.move_pages(&places);
            let length = groups(texture.words.len())?;
            let range = space.words.allocate(length);
            is_full |= range.is_none();
            added.push(space.handles.insert(Member {
                // Where there is none, all get new ones below.
                groups: range.unwrap_or(0..length),
                rooms: own,
            })?);
        }
        let entries = space.handles.capacity();
        let moves = match is_full || entries != self.entries {
            true => Some(space.rebuild(self, entries, groups(nothing_words)?, bounds)?),
            false => None,
        };
        Ok(Plan {
            space,
            added,
            moves,
        })
    }

    fn rooms(
        &mut self,
        textures: &[Packed],
        limits: &PageLimits,
    ) -> Result<Vec<Room>, RuntimeError> {
        let sizes = textures.iter().flat_map(|texture| {
            let pages = page_count(texture);
            std::iter::repeat_n(texture.texels.size(), pages)
        });
        let sizes: Vec<[u32; 2]> = sizes.collect();
        self.pages.allocate_all(&sizes, limits)
    }

    /// Puts all textures closely together in a buffer of their own size.
    fn rebuild(
        &mut self,
        before: &Self,
        entries: u32,
        nothing: u32,
        bounds: &Bounds,
    ) -> Result<Vec<Move>, RuntimeError> {
        self.entries = entries;
        self.head = entries_end(entries) / 4 + nothing;
        let most = bounds.buffer_bytes / GROUP_BYTES;
        let most = most.saturating_sub(u64::from(self.head));
        let most = u32::try_from(most).unwrap_or(u32::MAX);
        let lengths: Vec<u32> = self.lengths().collect();
        let rebuilt = before.words.rebuilt(lengths.into_iter(), most);
        let (words, placed) = rebuilt.map_err(|Overflow(groups)| {
            let bytes = (groups + u64::from(self.head)) * GROUP_BYTES;
            RuntimeError::Limit(format!(
                "textures of {bytes} bytes, and this device binds {} (max_storage_buffer_binding_size, \
                 max_buffer_size): remove textures, make a second set, or open a device that has more",
                bounds.buffer_bytes
            ))
        })?;
        self.words = words;
        for (member, groups) in self.handles.values_mut().zip(placed) {
            member.groups = groups;
        }
        let kept = before.handles.iter().filter_map(|(handle, old)| {
            let new = self.handles.get(handle)?;
            Some(Move {
                from: before.first_group(old),
                to: self.first_group(new),
                groups: u32::try_from(old.groups.len()).unwrap_or(0),
            })
        });
        Ok(joined(kept))
    }

    fn lengths(&self) -> impl Iterator<Item = u32> {
        let lengths = self.handles.iter().map(|(_, member)| member.groups.len());
        lengths.map(|length| u32::try_from(length).unwrap_or(u32::MAX))
    }
}

/// Pages of a texture's own that need room.
fn page_count(texture: &Packed) -> usize {
    match texture.has_images() {
        true => texture.texels.count() as usize,
        false => 0,
    }
}

/// First word behind so many entries of the table, a multiple of four.
fn entries_end(entries: u32) -> u32 {
    (table::ENTRIES + table::ENTRY_WORDS * entries).next_multiple_of(4)
}

fn groups(words: usize) -> Result<u32, RuntimeError> {
    u32::try_from(words.div_ceil(4)).map_err(|_| {
        let message = "a texture of more than 64 GiB: bake it smaller".to_owned();
        RuntimeError::Limit(message)
    })
}

/// Moves of neighbours that stay neighbours are one.
fn joined(moves: impl Iterator<Item = Move>) -> Vec<Move> {
    let mut joined: Vec<Move> = Vec::new();
    for next in moves {
        match joined.last_mut() {
            Some(last)
                if last.from + last.groups == next.from && last.to + last.groups == next.to =>
            {
                last.groups += next.groups;
            }
            _ => joined.push(next),
        }
    }
    joined
}
