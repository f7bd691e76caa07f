//! What of a pool is where: handles, words, pages. A change is planned on a copy, so that one that fails,
//! or whose future is dropped, leaves the pool as it was.

use std::ops::Range;

use vtex_shaders::Packed;
use vtex_shaders::set::{TextureHandle, table};

use super::handles::Handles;
use super::pages::{PageLimits, Pages, Room};
use super::words::{GROUP_BYTES, Words};

/// What bounds a pool.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Bytes of its buffer.
    pub(super) buffer_bytes: u64,
    pub(super) pages: PageLimits,
    /// Words of the texture that shows nothing.
    pub(super) nothing_words: usize,
}

/// What of a pool is where.
#[derive(Clone, Debug)]
pub(super) struct Space {
    pub(super) handles: Handles<Member>,
    pub(super) words: Words,
    pub(super) pages: Pages,
    /// Groups in front of the textures': the table, and the texture that shows nothing.
    head: u32,
    /// Entries in the table.
    pub(super) entries: u32,
}

/// What a texture of the pool has.
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

/// A pool with more textures in it.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) space: Space,
    /// The textures added, each by its index, in order.
    pub(super) added: Vec<(usize, TextureHandle)>,
    /// Of the textures that are kept where a new buffer is needed.
    pub(super) moves: Option<Vec<Move>>,
}

/// The textures that a pool has no room for, and why it has none for the first of them.
#[derive(Debug, Default)]
pub(super) struct Refused {
    pub(super) textures: Vec<usize>,
    pub(super) reason: Option<String>,
}

impl Refused {
    fn push(&mut self, texture: usize, reason: impl FnOnce() -> String) {
        self.textures.push(texture);
        self.reason.get_or_insert_with(reason);
    }
}

impl Space {
    pub(super) fn of_pool(pool: u32) -> Self {
        Self {
            handles: Handles::of_pool(pool),
            words: Words::default(),
            pages: Pages::default(),
            head: 0,
            entries: 0,
        }
    }

    /// First group of a texture in the buffer.
    pub(super) fn first_group(&self, member: &Member) -> u32 {
        self.head + member.groups.start
    }

    /// Bytes of its textures' words, with the table.
    pub(super) fn used_word_bytes(&self) -> u64 {
        self.buffer_bytes() - GROUP_BYTES * u64::from(self.words.free_groups())
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

    /// With those of the textures `wanted` that fit, whose texels get their places: no plan where none does.
    pub(super) fn with(
        &self,
        textures: &mut [Packed],
        wanted: &[usize],
        bounds: &Bounds,
    ) -> (Option<Plan>, Refused) {
        let mut refused = Refused::default();
        let with_words = self.with_room_for_words(textures, wanted, bounds, &mut refused);
        if with_words.is_empty() && !wanted.is_empty() {
            return (None, refused);
        }
        let mut space = self.clone();
        let placed = space.place(textures, &with_words, &bounds.pages, &mut refused);
        if placed.is_empty() && !wanted.is_empty() {
            return (None, refused);
        }
        refused.textures.sort_unstable();
        let mut added = Vec::with_capacity(placed.len());
        let mut is_full = false;
        for (index, rooms) in placed {
            let places: Vec<_> = rooms.iter().map(|room| room.place).collect();
            let texture = &mut textures[index];
            texture.move_pages(&places);
            let length = groups(texture);
            let range = space.words.allocate(length);
            is_full |= range.is_none();
            // Where there is none, all get new ones below.
            let groups = range.unwrap_or(0..length);
            let handle = space.handles.insert(Member { groups, rooms });
            added.extend(handle.map(|handle| (index, handle)));
        }
        let entries = space.handles.capacity_with(0);
        let moves =
            (is_full || entries != self.entries).then(|| space.rebuild(self, entries, bounds));
        let plan = Plan {
            space,
            added,
            moves,
        };
        (Some(plan), refused)
    }

    /// Those of the textures for which there are words and handles, wherever others have to move.
    fn with_room_for_words(
        &self,
        textures: &[Packed],
        wanted: &[usize],
        bounds: &Bounds,
        refused: &mut Refused,
    ) -> Vec<usize> {
        let mut used = u64::from(self.words.capacity() - self.words.free_groups());
        let mut fitting = Vec::new();
        for &index in wanted {
            let needed = used + u64::from(groups(&textures[index]));
            let entries = self.handles.capacity_with(fitting.len() + 1);
            let bytes = GROUP_BYTES * (u64::from(head_groups(entries, bounds)) + needed);
            if fitting.len() == self.handles.room() {
                let most = table::SLOT_MASK + 1;
                refused.push(index, || format!("a pool has handles for {most} textures"));
            } else if bytes > bounds.buffer_bytes {
                refused.push(index, || {
                    let most = bounds.buffer_bytes;
                    format!(
                        "words of {bytes} bytes, and a pool holds {most} (the device's \
                         max_storage_buffer_binding_size and max_buffer_size, and `pool_bytes`)"
                    )
                });
            } else {
                used = needed;
                fitting.push(index);
            }
        }
        fitting
    }

    /// Takes the rooms of textures, in order of their indices.
    fn place(
        &mut self,
        textures: &[Packed],
        wanted: &[usize],
        limits: &PageLimits,
        refused: &mut Refused,
    ) -> Vec<(usize, Vec<Room>)> {
        let size = |index: usize| textures[index].texels.size();
        let all = wanted
            .iter()
            .flat_map(|&index| std::iter::repeat_n(size(index), page_count(&textures[index])));
        self.pages.begin(all, limits);
        // The tallest first: what is cut off beside it serves the others.
        let mut order = wanted.to_vec();
        order.sort_by_key(|&index| std::cmp::Reverse([size(index)[1], size(index)[0]]));
        let mut placed = Vec::with_capacity(order.len());
        for index in order {
            let count = page_count(&textures[index]);
            match self.pages.allocate_all(size(index), count, limits) {
                Ok(rooms) => placed.push((index, rooms)),
                Err(reason) => refused.push(index, || reason),
            }
        }
        self.pages.hold(limits);
        placed.sort_unstable_by_key(|&(index, _)| index);
        placed
    }

    /// Puts all textures closely together in a buffer of their own size. They fit.
    fn rebuild(&mut self, before: &Self, entries: u32, bounds: &Bounds) -> Vec<Move> {
        self.entries = entries;
        self.head = head_groups(entries, bounds);
        let most = bounds.buffer_bytes / GROUP_BYTES;
        let most = most.saturating_sub(u64::from(self.head));
        let most = u32::try_from(most).unwrap_or(u32::MAX);
        let lengths: Vec<u32> = self.lengths().collect();
        let (words, placed) = before.words.rebuilt(lengths.into_iter(), most);
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
        joined(kept)
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

/// In the rooms that a texture needs.
pub(super) fn texels_of(texture: &Packed) -> u64 {
    let [x, y] = texture.texels.size().map(u64::from);
    x * y * page_count(texture) as u64
}

/// First word behind so many entries of the table, a multiple of four.
fn entries_end(entries: u32) -> u32 {
    (table::ENTRIES + table::ENTRY_WORDS * entries).next_multiple_of(4)
}

/// Groups in front of the textures'.
fn head_groups(entries: u32, bounds: &Bounds) -> u32 {
    let nothing = u32::try_from(bounds.nothing_words.div_ceil(4)).unwrap_or(u32::MAX);
    (entries_end(entries) / 4).saturating_add(nothing)
}

/// Of a texture's words. One whose words cannot be counted is refused as too large.
fn groups(texture: &Packed) -> u32 {
    u32::try_from(texture.words.len().div_ceil(4)).unwrap_or(u32::MAX)
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
